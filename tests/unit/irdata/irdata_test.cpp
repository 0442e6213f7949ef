// What the golden programs (tests/golden/programs/irdata) do not show: places, values of expressions, bounds, codes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "scripts/programs/irdata/code_table.hpp"
#include "scripts/programs/irdata/irdata.hpp"
#include "scripts/programs/irdata/translator.hpp"
#include "scripts/programs/program/machine.hpp"

namespace cellmirror::program {
namespace {

struct QuietWorld final : ProgramWorld {
  [[nodiscard]] JointValues joints() const override { return {std::numbers::pi / 2, 0.25}; }
  [[nodiscard]] Result<Pose> position() const override {
    Pose X_ZT = Pose::Identity();
    X_ZT.translation() = Eigen::Vector3d(0.5, 0, 0.25);
    return X_ZT;
  }
  [[nodiscard]] bool digital_input(std::size_t number) const override { return number == 3; }
  [[nodiscard]] double analogue_input(std::size_t number) const override { return static_cast<double>(number) / 2; }
  [[nodiscard]] bool digital_output(std::size_t number) const override { return number == 4; }
  [[nodiscard]] double analogue_output(std::size_t number) const override { return static_cast<double>(number) * 2; }
};

struct Parsed {
  std::shared_ptr<const Program> program;
  Diagnostics diagnostics;
};

Parsed parse(const std::string& text, const std::string& codes = {}) {
  Parsed parsed;
  parsed.program = irdata_language().parse(text, {"test.ird", codes}, parsed.diagnostics);
  return parsed;
}

// The value of `expression` in the variable of this type.
Value value_of(const std::string& type, const std::string& expression) {
  const Parsed parsed = parse("1, HEADER, test\n2, " + type + ", r\n3, INTEGER, n, 7\n4, REAL, x, 2.5\n" +
                              "5, LIST, l, INTEGER, -1, 1\n6, DATA, l, 10, 20, 30\n7, BOOLEAN, b, ON\n" +
                              "8, POSE, p, POSE(100, 200, 300, 0, 0, 90)\n9, JOINTS, j, JOINTS(1, 2, 3)\n" +
                              "10, END_HEADER\n11, SET, r, " + expression + "\n12, END\n");
  EXPECT_TRUE(parsed.program) << expression << "\n" << parsed.diagnostics.text();
  if (!parsed.program) return {};
  constexpr std::array<JointKind, 2> kJoints = {JointKind::revolute, JointKind::prismatic};
  Machine machine(parsed.program, kJoints);
  const QuietWorld world;
  Machine::Step step = machine.next(world, 100);
  while (step == Machine::Step::command) step = machine.next(world, 100);
  EXPECT_EQ(step, Machine::Step::ended) << expression << "\n" << machine.error().text();
  return *machine.variable("r");
}

std::string source_file(const char* path) {
  const char* root = std::getenv("CELLMIRROR_SOURCE_DIR");
  std::ifstream file(std::string(root == nullptr ? "." : root) + "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(IrdataExpression, integers) {
  const std::pair<const char*, std::int64_t> cases[] = {{"1 + 2 * 3", 7},
                                                        {"(1 + 2) * 3", 9},
                                                        {"10 - 4 - 3", 3},
                                                        {"-n", -7},
                                                        {"- - n", 7},
                                                        {"+n", 7},
                                                        {"n DIV 2", 3},
                                                        {"-n DIV 2", -3},
                                                        {"-n MOD 4", -3},
                                                        {"n * 2 MOD 4", 2},
                                                        {"l[-1] + l[0] + l[l[0] - 19]", 60},
                                                        {"FIRST(l)", -1},
                                                        {"LAST(l)", 1},
                                                        {"LENGTH(l)", 3},
                                                        {"ROUND(x)", 3},
                                                        {"ROUND(-x)", -3},
                                                        {"TRUNC(-x)", -2},
                                                        {"MAX(n, 3)", 7},
                                                        {"min(n, 3)", 3},
                                                        {"ABS(-n)", 7},
                                                        {"n AND 5", 5},
                                                        {"n OR 8", 15},
                                                        {"n XOR 5", 2},
                                                        {"NOT 0", -1},
                                                        {"9223372036854775807", INT64_MAX}};
  for (const auto& [text, expected] : cases)
    EXPECT_EQ(std::get<std::int64_t>(value_of("INTEGER", text)), expected) << text;
}

TEST(IrdataExpression, reals) {
  const std::pair<const char*, double> cases[] = {{"n", 7},
                                                  {"1 / 4", 0.25},
                                                  {"-x ^ 2", -6.25},
                                                  {"2 ^ -1", 0.5},
                                                  {"2 ^ 3 ^ 2", 512},
                                                  {"2 * x ^ 2", 12.5},
                                                  {"SIN(30)", 0.5},
                                                  {"SIN(n * 0 + 30)", 0.5},
                                                  {"ACOS(0.5)", 60},
                                                  {"ATAN2(-1, 0)", -90},
                                                  {"SQRT(6.25)", 2.5},
                                                  {"p.X", 100},
                                                  {"p.YAW", 90},
                                                  {"INV(p).X", -200},
                                                  {"(p @ p).Y", 300},
                                                  {"j.J2", 2},
                                                  {"POSE(x, 0, 0, 0, 0, 0).X", 2.5},
                                                  {"HERE.X", 500},
                                                  {"HERE_JOINTS.J1", 90},
                                                  {"HERE_JOINTS.J2", 250},
                                                  {"AIN(3)", 1.5},
                                                  {"AOUT(n)", 14},
                                                  {".5 + 1. + 1e-1 + 2E+0", 3.6},
                                                  {"PI", std::numbers::pi},
                                                  {"REAL(n) / 2", 3.5}};
  for (const auto& [text, expected] : cases)
    EXPECT_NEAR(std::get<double>(value_of("REAL", text)), expected, 1e-12) << text;
}

TEST(IrdataExpression, booleans) {
  const std::pair<const char*, bool> cases[] = {{"1 < 2", true},
                                                {"1 >= 2", false},
                                                {"x = 2.5", true},
                                                {"x <> 2.5", false},
                                                {"n <= 7", true},
                                                {"n > 7", false},
                                                {"NOT n = 7", false},
                                                {"NOT b OR b", true},
                                                {"OFF AND OFF OR ON", true},
                                                {"OFF AND (OFF OR ON)", false},
                                                {"b XOR TRUE", false},
                                                {"DIN(3)", true},
                                                {"DIN(n)", false},
                                                {"DOUT(4) = ON", true},
                                                {"b <> FALSE", true}};
  for (const auto& [text, expected] : cases) EXPECT_EQ(std::get<bool>(value_of("BOOLEAN", text)), expected) << text;
}

TEST(IrdataProgram, tells_line_column_and_record_of_statements) {
  const Parsed parsed = parse("10, HEADER, p\n20, END_HEADER\n\n; comment\n  30, PTP, JOINTS(1)\n40, END\n");
  ASSERT_TRUE(parsed.program) << parsed.diagnostics.text();
  EXPECT_EQ(parsed.program->name, "p");
  EXPECT_EQ(parsed.program->language, "irdata");
  const Place place = parsed.program->place(0);
  EXPECT_EQ(place.file, "test.ird");
  EXPECT_EQ(place.line, 5);
  EXPECT_EQ(place.column, 3);
  EXPECT_EQ(parsed.program->step_name(0), "N30");
}

TEST(IrdataProgram, knows_what_it_releases) {
  const Parsed parsed =
      parse("1, HEADER, p\n2, SEMAPHORE, s, 2\n3, SEMAPHORE, t\n4, END_HEADER\n5, RELEASE, s\n6, ACQUIRE, t\n7, END\n");
  ASSERT_TRUE(parsed.program) << parsed.diagnostics.text();
  EXPECT_TRUE(parsed.program->releases("s"));
  EXPECT_FALSE(parsed.program->releases("t"));
  ASSERT_EQ(parsed.program->semaphores.size(), 2U);
  EXPECT_EQ(parsed.program->semaphores[0].initial, 2U);
  EXPECT_EQ(parsed.program->semaphores[1].initial, 0U);
}

TEST(IrdataProgram, does_not_need_a_last_line_end_and_passes_over_a_byte_order_mark) {
  EXPECT_TRUE(parse("\xef\xbb\xbf"
                    "1, HEADER, p\r\n2, END_HEADER\r\n3, END")
                  .program);
}

TEST(IrdataProgram, reads_a_hundred_thousand_records) {
  std::string text = "1, HEADER, long\n2, END_HEADER\n";
  for (int record = 3; record < 100'000; ++record)
    text += std::to_string(record) + ", LIN, POSE(" + std::to_string(record) + ".5, 0, 300, 0, 90, 0), FLY\n";
  const Parsed parsed = parse(text + "100000, END\n");
  ASSERT_TRUE(parsed.program) << parsed.diagnostics.text();
  EXPECT_EQ(parsed.program->statements.size(), 99'998U);
}

TEST(IrdataProgram, reports_faults_of_every_line_and_keeps_a_bounded_number) {
  std::string text = "1, HEADER, wrong\n2, END_HEADER\n";
  for (int record = 3; record < 50'003; ++record)
    text += std::to_string(record) + ", LIN, nowhere" + std::to_string(record) + "\n";
  const Parsed parsed = parse(text);
  EXPECT_FALSE(parsed.program);
  EXPECT_EQ(parsed.diagnostics.errors(), 50'001U);  // and END is missing
  EXPECT_EQ(parsed.diagnostics.all().size(), Diagnostics::kKept);
}

TEST(IrdataProgram, every_finding_says_what_to_do) {
  const Parsed parsed = parse(
      "1 HEADER\n2, LIST, l\n3, INTEGER, n, x\n4, DATA\n5, PTP\n6, XYZ\n7, 1234\n8, IF, 1\n9, SET, n, n[1].X\n10, "
      "JUMP, 3, 4\n"
      "11, CALL, \n12, WAIT_INPUT, 0, ON, -1, a\n13, ACQUIRE, s\n; %\n14, SIN, n\n");
  EXPECT_GE(parsed.diagnostics.errors(), 12U);
  for (const Diagnostic& finding : parsed.diagnostics.all()) {
    EXPECT_FALSE(finding.remedy.empty()) << finding.text();
    EXPECT_GT(finding.place.line, 0) << finding.text();
    EXPECT_GT(finding.place.column, 0) << finding.text();
  }
}

TEST(IrdataProgram, too_long_texts_are_refused) {
  const std::string text(kLargestProgramText + 1, '\n');
  const Parsed parsed = parse(text);
  EXPECT_FALSE(parsed.program);
  EXPECT_EQ(parsed.diagnostics.errors(), 1U);
}

TEST(IrdataProgram, too_many_variables_are_refused) {
  std::string text = "1, HEADER, p\n";
  for (std::size_t i = 0; i < kMostVariables; ++i)
    text += std::to_string(i + 2) + ", REAL, v" + std::to_string(i) + "\n";
  // The loop's own variable is one too many as well.
  const Parsed parsed =
      parse(text + "200000, REAL, w\n200001, END_HEADER\n200002, LOOP, 3\n200003, END_LOOP\n200004, END\n");
  EXPECT_FALSE(parsed.program);
  EXPECT_GE(parsed.diagnostics.errors(), 2U);
}

TEST(IrdataCodes, built_in_table_has_one_code_for_every_operation) {
  Diagnostics diagnostics;
  const auto sut = irdata::CodeTable::read(irdata::built_in_codes(), "codes", diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
  std::set<irdata::Operation> seen;
  for (const auto& row : sut.rows()) EXPECT_TRUE(seen.insert(row.operation).second) << row.code;
  EXPECT_EQ(seen.size(), irdata::kOperations);
  EXPECT_EQ(irdata::built_in_codes(), source_file("config/languages/irdata_codes.tsv"));
}

TEST(IrdataCodes, own_table_replaces_the_built_in_one) {
  const std::string program = "1, HEADER, p\n2, END_HEADER\n3, 7, JOINTS(1)\n4, END\n";
  EXPECT_FALSE(parse(program).program);
  EXPECT_TRUE(parse(program, "7\tPTP\n").program);
  EXPECT_FALSE(parse("1, HEADER, p\n2, END_HEADER\n3, 300, JOINTS(1)\n4, END\n", "7\tPTP\n").program);
  const Parsed wrong = parse(program, "7\tPTP\n8\tNOTHING\n");
  EXPECT_FALSE(wrong.program);
  ASSERT_EQ(wrong.diagnostics.all().size(), 1U);
  EXPECT_EQ(wrong.diagnostics.all()[0].place.file, "irdata_codes.tsv");
  EXPECT_EQ(wrong.diagnostics.all()[0].place.line, 2);
}

TEST(IrdataPage, names_every_operation_and_its_example_is_a_program) {
  const std::string page = source_file("docs/languages/irdata.md");
  ASSERT_FALSE(page.empty());
  for (const irdata::OperationRow& row : irdata::operations())
    EXPECT_NE(page.find(row.name), std::string::npos) << row.name;
  const std::size_t begin = page.find("```\n") + 4;
  const Parsed parsed = parse(page.substr(begin, page.find("```", begin) - begin));
  EXPECT_TRUE(parsed.program) << parsed.diagnostics.text();
}

}  // namespace
}  // namespace cellmirror::program
