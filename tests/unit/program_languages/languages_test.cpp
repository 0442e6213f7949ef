// The list of languages, and what golden traces do not show of CRCL.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "scripts/programs/crcl/xml_reader.hpp"
#include "scripts/programs/languages/languages.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/trace.hpp"

namespace cellmirror::program {
namespace {

TEST(Languages, AreThoseOfTheManualAndOurs) {
  std::vector<std::string_view> names;
  for (const Language& language : languages()) names.push_back(language.name);
  EXPECT_EQ(names, (std::vector<std::string_view>{"irdata", "srcl", "jet_boom", "jet_tarm", "crcl", "rapid"}));
}

TEST(Languages, AreFoundByNameInAnyCase) {
  const auto found = find_language("IrData");
  ASSERT_TRUE(found);
  EXPECT_EQ((*found)->name, "irdata");
  const auto unknown = find_language("basic\n");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().text(),
            "there is no robot language 'basic\\x0a'; one of: irdata, srcl, jet_boom, jet_tarm, crcl, rapid");
}

TEST(Languages, AreFoundByTheExtensionsOfTheirFiles) {
  std::set<std::string_view> extensions;
  for (const Language& language : languages()) {
    ASSERT_FALSE(language.extensions.empty());
    for (const std::string_view extension : language.extensions) {
      EXPECT_TRUE(extension.starts_with('.')) << extension;
      EXPECT_TRUE(extensions.insert(extension).second) << extension << " belongs to two languages";
      EXPECT_EQ(language_of_extension(extension), &language);
    }
  }
  EXPECT_EQ(language_of_extension(".txt"), nullptr);
}

TEST(Languages, RefuseTextThatIsTooLargeAndSayWhereTheyStop) {
  const std::string large(kLargestProgramText + 1, ' ');
  for (const Language& language : languages()) {
    Diagnostics diagnostics;
    EXPECT_EQ(language.parse(large, {.file = "large", .codes = {}}, diagnostics), nullptr) << language.name;
    EXPECT_FALSE(diagnostics.ok()) << language.name;
  }
}

TEST(Languages, ReportForEveryByteThatIsNoProgram) {
  for (const Language& language : languages()) {
    for (int byte = 0; byte < 256; ++byte) {
      Diagnostics diagnostics;
      const std::string text(3, static_cast<char>(byte));
      const auto program = language.parse(text, {.file = "bytes", .codes = {}}, diagnostics);
      EXPECT_EQ(program == nullptr, !diagnostics.ok()) << language.name << " " << byte;
    }
  }
}

struct NoWorld final : ProgramWorld {
  [[nodiscard]] JointValues joints() const override { return {}; }
  [[nodiscard]] Result<Pose> position() const override { return Pose::Identity(); }
  [[nodiscard]] bool digital_input(std::size_t /*number*/) const override { return false; }
  [[nodiscard]] double analogue_input(std::size_t /*number*/) const override { return 0; }
  [[nodiscard]] bool digital_output(std::size_t /*number*/) const override { return false; }
  [[nodiscard]] double analogue_output(std::size_t /*number*/) const override { return 0; }
};

// The canonical commands without their lines, or what is wrong.
std::string commands_of(std::string_view language, std::string_view text) {
  Diagnostics diagnostics;
  const auto program = (*find_language(language))->parse(text, {.file = "task", .codes = {}}, diagnostics);
  if (program == nullptr) return diagnostics.text();
  constexpr std::array<JointKind, 4> kJoints = {JointKind::revolute, JointKind::revolute, JointKind::revolute,
                                                JointKind::prismatic};
  Machine machine(program, kJoints);
  std::string out;
  while (machine.next(NoWorld(), 100) == Machine::Step::command) {
    const std::string line = trace_line(*program, machine.command());
    out += line.substr(line.find(' ') + 1) + "\n";
  }
  return out;
}

TEST(Languages, SayTheSameInTheirOwnWords) {
  const std::string expected =
      "move ptp to joints 0.174533 -0.349066 0.523599 0.250000\n"
      "delay 0.500000\n"
      "script DRAW_SCENE\n"
      "move ptp to joints 0.000000 0.000000 0.000000 0.100000\n";
  EXPECT_EQ(commands_of("irdata",
                        "1, HEADER, task\n2, END_HEADER\n10, PTP, JOINTS(10, -20, 30, 250)\n20, WAIT_TIME, 0.5\n"
                        "30, COMMENT, %DRAW_SCENE\n40, PTP, JOINTS(0, 0, 0, 100)\n50, END\n"),
            expected);
  EXPECT_EQ(commands_of("srcl",
                        "PROGRAMM TASK\nPTP STELLUNG(10, -20, 30, 250)\nWARTE 0.5\n;%DRAW_SCENE\n"
                        "PTP STELLUNG(0, 0, 0, 100)\n"),
            expected);
  EXPECT_EQ(commands_of("jet_boom",
                        "JET_BOOM 1\nNAME task\nJOINTS 4\nPOINT A 10 -20 30 250\nDWELL 0.5\n% DRAW_SCENE\n"
                        "POINT B 0 0 0 100\nEND\n"),
            expected);
  EXPECT_EQ(commands_of("jet_tarm",
                        "JET_TARM 1\nNAME task\nJOINTS 4\nPOINT A J1=10 J2=-20 J3=30 J4=250\nDWELL 0.5\n"
                        "% DRAW_SCENE\nPOINT B J1=0 J2=0 J3=0 J4=100\nEND\n"),
            expected);
  const auto joint = [](int number, int value) {
    return fmt::format(
        "<ActuateJoint><JointNumber>{}</JointNumber><JointPosition>{}</JointPosition><JointDetails/>"
        "</ActuateJoint>",
        number, value);
  };
  const auto command = [](std::string_view type, const std::string& content) {
    return fmt::format("<MiddleCommand xsi:type=\"{}Type\"><CommandID>2</CommandID>{}</MiddleCommand>", type, content);
  };
  EXPECT_EQ(
      commands_of("crcl", "<CRCLProgram xmlns:xsi=\"x\"><InitCanon><CommandID>1</CommandID></InitCanon>" +
                              command("SetAngleUnits", "<UnitName>degree</UnitName>") +
                              command("SetLengthUnits", "<UnitName>millimeter</UnitName>") +
                              command("ActuateJoints", joint(1, 10) + joint(2, -20) + joint(3, 30) + joint(4, 250)) +
                              command("Dwell", "<DwellTime>0.5</DwellTime>") +
                              command("Message", "<Message>%DRAW_SCENE</Message>") +
                              command("ActuateJoints", joint(1, 0) + joint(2, 0) + joint(3, 0) + joint(4, 100)) +
                              "<EndCanon><CommandID>9</CommandID></EndCanon></CRCLProgram>"),
      expected);
  EXPECT_EQ(
      commands_of("rapid",
                  "MODULE task\nPROC main()\n"
                  "MoveAbsJ [[10,-20,30,250,9E9,9E9],[9E9,9E9,9E9,9E9,9E9,9E9]],vmax,fine,tool0;\nWaitTime 0.5;\n"
                  "!%DRAW_SCENE\n"
                  "MoveAbsJ [[0,0,0,100,9E9,9E9],[9E9,9E9,9E9,9E9,9E9,9E9]],vmax,fine,tool0;\nENDPROC\nENDMODULE\n"),
      expected);
}

std::string crcl(std::string_view commands) {
  return fmt::format(
      "<CRCLProgram xmlns:xsi=\"x\"><InitCanon><CommandID>1</CommandID></InitCanon>\n{}\n"
      "<EndCanon><CommandID>9</CommandID></EndCanon></CRCLProgram>",
      commands);
}

std::shared_ptr<const Program> parse_crcl(const std::string& text, Diagnostics& diagnostics) {
  return (*find_language("crcl"))->parse(text, {.file = "a/b/weld.v2.crcl", .codes = {}}, diagnostics);
}

TEST(Crcl, CallsStepsByTheirNameOrTheirId) {
  Diagnostics diagnostics;
  const auto program =
      parse_crcl(crcl("<MiddleCommand xsi:type=\"DwellType\"><CommandID>12</CommandID><DwellTime>1"
                      "</DwellTime></MiddleCommand>\n<MiddleCommand xsi:type=\"DwellType\"><Name>settle"
                      "</Name><CommandID>13</CommandID><DwellTime>1</DwellTime></MiddleCommand>"),
                 diagnostics);
  ASSERT_NE(program, nullptr) << diagnostics.text();
  EXPECT_EQ(program->name, "weld.v2");
  EXPECT_EQ(program->step_name(0), "command 12");
  EXPECT_EQ(program->step_name(1), "settle");
  EXPECT_EQ(program->place(1).line, 3);
  EXPECT_EQ(program->place(1).column, 1);
}

TEST(Crcl, BoundsWhatOneCommandMayHold) {
  std::string points;
  for (std::size_t n = 0; n <= crcl::kMostNodes; ++n) points += "<a/>";
  Diagnostics diagnostics;
  EXPECT_EQ(parse_crcl(crcl("<MiddleCommand xsi:type=\"DwellType\">" + points + "</MiddleCommand>"), diagnostics),
            nullptr);
  EXPECT_NE(diagnostics.text().find("an element with more than 500000 in it"), std::string::npos);
}

// Looking for each element among those before it would take minutes.
TEST(Crcl, ReadsACommandOfManyElementsThatDoNotBelongThereOrAreRepeated) {
  constexpr std::size_t kEach = 200'000;
  std::string content;
  for (std::size_t n = 0; n < kEach; ++n) content += "<x/>";
  for (std::size_t n = 0; n < kEach; ++n) content += "<Name/>";
  Diagnostics diagnostics;
  EXPECT_EQ(parse_crcl(crcl("<MiddleCommand xsi:type=\"MessageType\"><CommandID>2</CommandID><Message>hello</Message>" +
                            content + "</MiddleCommand>"),
                       diagnostics),
            nullptr);
  EXPECT_EQ(diagnostics.errors(), kEach + (kEach - 1));
}

TEST(Crcl, ReadsAProgramOf100000Commands) {
  std::string commands;
  for (int n = 0; n < 100'000; ++n) {
    commands += fmt::format(
        "<MiddleCommand xsi:type=\"DwellType\"><CommandID>{}</CommandID><DwellTime>0.5</DwellTime></MiddleCommand>\n",
        n + 2);
  }
  Diagnostics diagnostics;
  const auto program = parse_crcl(crcl(commands), diagnostics);
  ASSERT_NE(program, nullptr) << diagnostics.text();
  EXPECT_EQ(program->statements.size(), 100'001U);
}

}  // namespace
}  // namespace cellmirror::program
