// Index, table, handlers and reference page agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "scripts/commands/execute.hpp"
#include "scripts/lang/command_table.hpp"
#include "scripts/lang/help.hpp"
#include "tests/golden/scripts/recording_host.hpp"
#include "tests/unit/scripts/test_text.hpp"

namespace cellmirror::script {
namespace {

std::vector<std::vector<std::string>> index_rows() {
  std::ifstream in(source_folder() / "tests" / "data" / "commands.tsv");
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(in, line);  // the names of the columns
  while (std::getline(in, line)) {
    std::vector<std::string> row;
    std::istringstream columns(line);
    for (std::string cell; std::getline(columns, cell, '\t');) row.push_back(cell);
    if (!row.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

std::string file_content(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

TEST(CommandTable, HasARowForEachRowOfTheIndexInItsOrder) {
  const auto rows = index_rows();
  ASSERT_EQ(rows.size(), kIndexRows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Form& sut = *forms()[i];
    EXPECT_EQ(sut.section, rows[i][0]) << sut.syntax;
    EXPECT_EQ(sut.name, rows[i][1]) << sut.syntax;
    EXPECT_EQ(sut.syntax, rows[i][2]);
    EXPECT_EQ(sut.origin, Origin::manual) << sut.syntax;
    EXPECT_EQ(static_cast<std::size_t>(sut.id), i) << sut.syntax;
    if (rows[i].size() > 4 && !rows[i][4].empty()) {
      EXPECT_EQ(sut.example, rows[i][4]);
    }
  }
}

// The last group of the manual to be implemented was 1.2.7.
TEST(CommandsAsText, SaysThatAllAreImplemented) {
  const std::string text = commands_as_text();
  EXPECT_NE(text.find(fmt::format("{} forms, all implemented", kFormCount)), std::string::npos);
  EXPECT_EQ(text.find("not available"), std::string::npos);
}

TEST(CommandTable, MarksWhatStandsBehindTheIndexAsOurs) {
  ASSERT_EQ(forms().size(), kFormCount);
  for (std::size_t i = kIndexRows; i < forms().size(); ++i) EXPECT_EQ(forms()[i]->origin, Origin::ours);
}

TEST(CommandTable, EveryCommandHasAHandlerAndNoConventionHas) {
  for (const Form* form : forms()) EXPECT_EQ(has_handler(form->id), form->kind == FormKind::command) << form->syntax;
}

TEST(CommandTable, EveryRowHasOneLineOfHelp) {
  for (const Form* form : forms()) {
    EXPECT_FALSE(form->help.empty()) << form->syntax;
    EXPECT_EQ(form->help.find('\n'), std::string_view::npos) << form->syntax;
  }
}

TEST(CommandTable, FindsCommandsWithoutRegardToCaseAndNothingElse) {
  for (const std::string& name : command_names()) {
    ASSERT_FALSE(forms_of(name).empty()) << name;
    EXPECT_EQ(forms_of(name).front()->name, name);
    EXPECT_EQ(forms_of(lower_case(name)).data(), forms_of(name).data());
    EXPECT_TRUE(forms_of(name + "x").empty());
    EXPECT_TRUE(forms_of(name.substr(0, name.size() - 1)).empty() || name == "VV_SET_LUT_PAR") << name;
  }
  EXPECT_EQ(forms_of("POS_ROB").size(), 6U);
  EXPECT_EQ(forms_of("MOVE_ROB").size(), 8U);
  EXPECT_EQ(forms_of("SET_USSPAR").size(), 3U);
  EXPECT_EQ(forms_of("SET_COLLPAR").size(), 3U);
  EXPECT_EQ(forms_of("eladyn_geo_def").size(), 3U);
  EXPECT_TRUE(forms_of("#").empty());
  EXPECT_TRUE(forms_of("").empty());
}

TEST(ReferencePage, IsTheCommittedOne) {
  const std::filesystem::path page = source_folder() / "docs" / "script-reference.md";
  if (std::getenv("CELLMIRROR_UPDATE_GOLDEN") != nullptr) std::ofstream(page, std::ios::binary) << reference_page();
  EXPECT_EQ(reference_page(), file_content(page))
      << "run this test with CELLMIRROR_UPDATE_GOLDEN=1 and commit the page";
}

TEST(ReferencePage, HasAnEntryForEachForm) {
  const std::string page = reference_page();
  for (const Form* form : forms()) EXPECT_EQ(count_of(page, fmt::format("\n{}\n", form->syntax)), 1U) << form->syntax;
  EXPECT_EQ(count_of(page, "\n```\n\n"), kFormCount);
}

TEST(CommandsAsJson, HasTheBindingKeysForEachForm) {
  const nlohmann::json document = nlohmann::json::parse(commands_as_json());
  ASSERT_EQ(document["commands"].size(), kFormCount);
  for (std::size_t i = 0; i < kFormCount; ++i) {
    const nlohmann::json& row = document["commands"][i];
    EXPECT_EQ(row["name"], forms()[i]->name);
    EXPECT_EQ(row["syntax"], forms()[i]->syntax);
    EXPECT_EQ(row["section"], forms()[i]->section);
    EXPECT_EQ(row["help"], forms()[i]->help);
    EXPECT_EQ(row["implemented"], true);
  }
  EXPECT_EQ(document["our_tables"]["A.1"].size(), object_attributes().size());
}

// The simulation knows bits and indices, SCRIPT their words: one table for both.
TEST(OurTables, AreThoseOfTheSimulation) {
  ASSERT_EQ(object_attributes().size(), kTissueAttributeWords.size());
  for (std::size_t i = 0; i < kTissueAttributeWords.size(); ++i) {
    EXPECT_EQ(object_attributes()[i].token, kTissueAttributeWords.at(i));
    EXPECT_EQ(object_attributes()[i].bit, 1U << i);
  }
  EXPECT_EQ(object_attributes()[4].token, "CUT");
  EXPECT_TRUE(has(static_cast<std::uint16_t>(object_attributes()[4].bit), TissueAttribute::cut));
  EXPECT_EQ(object_attributes()[11].bit, static_cast<std::uint32_t>(TissueAttribute::wet));

  ASSERT_EQ(plausibility_flags().size(), kTissueLimitActionWords.size());
  EXPECT_EQ(plausibility_flags()[0].bit, static_cast<std::uint32_t>(TissueLimitAction::count));
  EXPECT_EQ(plausibility_flags()[3].token, "RELEASE");
  EXPECT_EQ(plausibility_flags()[3].bit, static_cast<std::uint32_t>(TissueLimitAction::release));
  EXPECT_EQ(plausibility_flags()[5].bit, static_cast<std::uint32_t>(TissueLimitAction::report));

  ASSERT_EQ(plausibility_tokens().size(), kTissueLimits);
  for (std::size_t i = 0; i < kTissueLimits; ++i)
    EXPECT_EQ(plausibility_tokens()[i].token, word(static_cast<TissueLimit>(i)));
  EXPECT_EQ(plausibility_tokens()[std::to_underlying(TissueLimit::grip_force)].unit, Unit::newton);
  EXPECT_EQ(plausibility_tokens()[std::to_underlying(TissueLimit::node_speed)].unit, Unit::mm_per_s);
  EXPECT_EQ(plausibility_tokens()[std::to_underlying(TissueLimit::strain)].unit, Unit::none);
}

TEST(OurTables, AreMarkedAsOursWhereverTheyArePrinted) {
  const nlohmann::json tables = nlohmann::json::parse(commands_as_json())["our_tables"];
  EXPECT_EQ(tables["A.4"].size(), kTissueLimitActionWords.size());
  EXPECT_EQ(tables["A.5"].size(), kTissueLimits);
  EXPECT_EQ(tables["A.1"][2]["token"], "GRASP");
  EXPECT_EQ(tables["A.1"][2]["bit"], 4);
  EXPECT_EQ(tables["A.5"][0]["unit"], "mm/s");
  EXPECT_EQ(tables["A.5"][0]["at_start"], "2000 mm/s, COUNT DISCARD");
  EXPECT_EQ(tables["A.5"][1]["at_start"], "off");
  EXPECT_EQ(tables["A.5"][3]["at_start"], "1 N, COUNT CLAMP");
  for (const std::string_view table : {"A.1", "A.4", "A.5"}) {
    const std::string text = commands_as_text();
    const std::size_t at = text.find(fmt::format("Table {}", table));
    ASSERT_NE(at, std::string::npos) << table;
    EXPECT_NE(text.substr(at, text.find('\n', at) - at).find("(ours)"), std::string::npos) << table;
  }
  EXPECT_NE(reference_page().find("does not contain them. They are ours."), std::string::npos);
}

TEST(CommandsAsText, ShowsEachFormAndOurTables) {
  const std::string text = commands_as_text();
  for (const Form* form : forms()) EXPECT_NE(text.find(form->syntax), std::string::npos) << form->syntax;
  for (const Attribute& row : object_attributes()) EXPECT_NE(text.find(row.token), std::string::npos);
  for (const PlausibilityToken& row : plausibility_tokens()) EXPECT_NE(text.find(row.token), std::string::npos);
}

TEST(Help, ShowsSynopsisUnitsAndOurDefinition) {
  const std::string sut = help_text("set_campar");
  EXPECT_NE(sut.find("SET_CAMPAR <CAM_id> <view_dist> <fovy_angle>"), std::string::npos);
  EXPECT_NE(sut.find("more than 0 m"), std::string::npos);
  EXPECT_NE(help_text("POS_ROB").find("SCREEN_INC"), std::string::npos);
  EXPECT_EQ(help_text("ROBAKT"), "there is no command ROBAKT; did you mean ROBACT or ROBOT?\n");
}

TEST(Help, NamesEveryParameterOfEveryForm) {
  for (const Form* form : forms()) {
    const std::string sut = help_text(*form);
    EXPECT_NE(sut.find(form->help), std::string::npos) << form->syntax;
    for (const Parameter& parameter : form->parameters) {
      if (parameter.kind == ParameterKind::word) continue;
      EXPECT_NE(sut.find(fmt::format("<{}>", parameter.name)), std::string::npos) << form->syntax;
    }
  }
  EXPECT_NE(help_text("VV_SET_LUT").find("<volume>               voxel volume: name of a voxel volume; optional"),
            std::string::npos);
}

TEST(Completion, OffersWhatMayStandNext) {
  const cellmirror::testing::FakeNames names;
  using Words = std::vector<std::string>;
  EXPECT_EQ(complete("rob_cart_v", &names), Words{"rob_cart_vel_scal"});
  EXPECT_EQ(complete("ROB", &names).size(), 28U);
  EXPECT_EQ(complete("MOVE_ROB PUMA_762 ", &names), (Words{"PTP", "LIN"}));
  EXPECT_EQ(complete("MOVE_ROB PUMA_762 LIN ", &names),
            (Words{"JOINT_ABS", "JOINT_INC", "FRAME_ABS", "FRAME_INC", "TOOL_INC", "SCREEN_INC"}));
  EXPECT_EQ(complete("ROBACT PU", &names), Words{"PUMA_762"});
  EXPECT_EQ(complete("POS_ROB PUMA_762 ", &names),
            (Words{"JOINT_ABS", "JOINT_INC", "FRAME_ABS", "FRAME_INC", "TOOL_INC", "SCREEN_INC"}));
  EXPECT_EQ(complete("POS_ROB PUMA_762 FRAME_INC X 1 ", &names), (Words{"Y", "Z", "A", "B", "C"}));
  EXPECT_EQ(complete("STVW 0 TIME 3 ", &names), (Words{"VP", "LP", "TW", "VA", "FCP", "BCP"}));
  EXPECT_EQ(complete("STVW 0 VP 1 ", &names), Words{});
  EXPECT_EQ(complete("ROBOT PUMA_762 s", &names), (Words{"send_on", "send_off"}));
  EXPECT_EQ(complete("CONNECT Toolbox.Tool1 ", &names), Words{"TO"});
  EXPECT_EQ(complete("FRAME_TO_WFRM Toolbox.Tool1 TO Mantec_1.HAND ", &names), Words{"Tool1_WFRM"});
  EXPECT_EQ(complete("EFFECTS P", nullptr), (Words{"PULSE", "POOL_RIPPLES"}));
  EXPECT_EQ(complete("VV_SET_LUT LIN_LUT ", &names), (Words{"Part_CT", "Table.Head_CT"}));
  EXPECT_EQ(complete("VV_CLIP_POS CLP1 ELE 1 ", &names), (Words{"AZI", "DIST"}));
  EXPECT_EQ(complete("VV_CLIP_POS CLP1 ELE 1 DIST 3 AZI 2 P", &names), Words{"Part_CT"});
  EXPECT_EQ(complete("NO_SUCH ", &names), Words{});
  EXPECT_EQ(complete("", nullptr).size(), command_names().size());
}

}  // namespace
}  // namespace cellmirror::script
