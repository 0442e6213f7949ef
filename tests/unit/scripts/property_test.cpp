// Properties over generated text.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "rt_core/base/units.hpp"
#include "scripts/lang/command_table.hpp"
#include "scripts/lang/help.hpp"
#include "tests/unit/scripts/test_text.hpp"

namespace cellmirror::script {
namespace {

std::string random_case(const std::string& word) {
  std::string out = word;
  for (char& c : out) {
    const bool upper = *rc::gen::arbitrary<bool>();
    if (upper && c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (!upper && c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::string random_blank() {
  return *rc::gen::element<std::string>(" ", "  ", "\t", "\n", "\r\n", "\n# comment; WAIT;\n", " \n \n ");
}

// A word that SCRIPT text may hold, right or wrong.
std::string random_word() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all(command_names().begin(), command_names().end());
    for (const Form* form : forms()) {
      for (const Parameter& parameter : form->parameters) {
        if (parameter.kind == ParameterKind::word) all.emplace_back(parameter.name);
        if (!parameter.label.empty()) all.emplace_back(parameter.label);
        for (const Choice& choice : parameter.choices) all.emplace_back(choice.word);
      }
    }
    for (const char* word : {"PUMA_762", "MANTEC_RM3", "ZELLENKRAN", "Toolbox.Tool1", "CAMERA_5", "USS_5", "Tool1_WFRM",
                             "0", "1", "-2.5", "0x10", "1e5", "nan", ",", ";", "#", "J_1", "a..b",
                             "\xe2\x80\x93"
                             "1"})
      all.emplace_back(word);
    return all;
  }();
  return words[*rc::gen::inRange<std::size_t>(0, words.size())];
}

RC_GTEST_PROP(ScriptText, AnyBytesAreReadToTheirEndWithFindingsWithinThem, (const std::string& bytes)) {
  const cellmirror::testing::FakeNames names;
  const auto lines = std::count(bytes.begin(), bytes.end(), '\n') + 1;
  for (const Diagnostic& finding : findings_of_file(bytes, &names)) {
    RC_ASSERT(finding.place.line >= 0);
    RC_ASSERT(finding.place.line <= lines);
    RC_ASSERT(!finding.message.empty());
  }
  findings_of(bytes, &names);
}

RC_GTEST_PROP(ScriptText, AnyWordsAreReadOrRefusedButNeverBoth, ()) {
  cellmirror::testing::FakeNames names;
  names.active = *rc::gen::element<std::string>("", "PUMA_762", "ZELLENKRAN");
  std::string text = command_names()[*rc::gen::inRange<std::size_t>(0, command_names().size())];
  const auto count = *rc::gen::inRange(0, 12);
  for (int i = 0; i < count; ++i) text += " " + random_word();
  CommandReader reader(text, "file.spt", TextKind::file);
  ParsedCommand command;
  for (;;) {
    Diagnostics findings;
    const CommandReader::Step step = reader.next(&names, command, findings);
    if (step == CommandReader::Step::end) break;
    RC_ASSERT((step == CommandReader::Step::command) == findings.ok());
  }
}

RC_GTEST_PROP(ScriptText, CheckingTwiceGivesTheSame, (const std::string& bytes)) {
  const auto text = [](const std::vector<Diagnostic>& findings) {
    std::string all;
    for (const Diagnostic& finding : findings) all += finding.text() + "\n";
    return all;
  };
  RC_ASSERT(text(findings_of_file(bytes)) == text(findings_of_file(bytes)));
}

RC_GTEST_PROP(ScriptText, BlanksCommentsAndCaseOfKeywordsDoNotMatter, ()) {
  const cellmirror::testing::FakeNames names;
  std::vector<double> joints;
  std::string text = random_case("POS_ROB") + random_blank() + "MANTEC_RM3" + random_blank() + random_case("JOINT_ABS");
  const auto count = *rc::gen::inRange(1, 7);
  for (int i = 0; i < count; ++i) {
    joints.push_back(*rc::gen::inRange(-1'000'000, 1'000'000) / 1000.0);
    text += random_blank() + fmt::format("{}", joints.back());
  }
  const Read sut(text, &names);
  RC_ASSERT(sut.fine);
  RC_ASSERT(sut.command.id() == FormId::pos_rob_joint_abs);
  RC_ASSERT(sut.command.size() == joints.size() + 1);
  for (std::size_t i = 0; i < joints.size(); ++i) RC_ASSERT(sut.command.number(i + 1) == rad_from_deg(joints[i]));
}

RC_GTEST_PROP(Numbers, PrintedAndReadAgainAreTheSame, (double value)) {
  RC_PRE(std::isfinite(value));
  const Read sut(fmt::format("SET_EXT_TCP_TEST on {} {:e} 0 0", value, value), nullptr);
  RC_ASSERT(sut.fine);
  RC_ASSERT(sut.command.number(1) == value);
  RC_ASSERT(std::abs(sut.command.number(2) - value) <= 1e-6 * std::abs(value));
}

RC_GTEST_PROP(Completion, NeverFailsAndKeepsToThePrefix, ()) {
  const cellmirror::testing::FakeNames names;
  std::string line;
  const auto count = *rc::gen::inRange(0, 8);
  for (int i = 0; i < count; ++i) line += random_word() + " ";
  const std::string prefix = random_word().substr(0, 2);
  if (prefix.find_first_of(" ,") != std::string::npos) return;
  for (const std::string& candidate : complete(line + prefix, &names))
    RC_ASSERT(equal_ignoring_case(candidate.substr(0, prefix.size()), prefix));
}

}  // namespace
}  // namespace cellmirror::script
