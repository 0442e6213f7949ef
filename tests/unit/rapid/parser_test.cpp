// What golden traces do not show: names, places, exact values, bounds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "scripts/programs/rapid/lexer.hpp"
#include "scripts/programs/rapid/rapid.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::program;

struct Parsed {
  std::shared_ptr<const Program> program;
  Diagnostics findings;
};

Parsed parse(std::string_view text) {
  Parsed parsed;
  parsed.program = rapid_language().parse(text, {"shelf/test.mod", {}}, parsed.findings);
  return parsed;
}

std::string main_with(std::string_view statements) {
  return fmt::format("MODULE Shelf\nPROC main()\n{}\nENDPROC\nENDMODULE\n", statements);
}

constexpr std::string_view kNone9 = "[9E9,9E9,9E9,9E9,9E9,9E9]";

template <class T>
const T* first(const Program& program) {
  for (const Statement& statement : program.statements) {
    if (const T* const found = std::get_if<T>(&statement)) return found;
  }
  return nullptr;
}

const Value& constant(const Program& program, ExpressionId id) {
  EXPECT_EQ(program.expressions[id].which, Operator::constant);
  return program.constants[program.expressions[id].payload];
}

TEST(RapidLanguage, IsInTheRegistersForm) {
  const Language& sut = rapid_language();
  EXPECT_EQ(sut.name, "rapid");
  EXPECT_EQ(sut.extensions.front(), ".mod");
  EXPECT_TRUE(sut.codes_file.empty());
}

TEST(RapidLanguage, NamesAProgramAfterItsModule) {
  const Parsed sut = parse(main_with("Set do1;"));
  ASSERT_TRUE(sut.program) << sut.findings.text();
  EXPECT_EQ(sut.program->name, "Shelf");
  EXPECT_EQ(sut.program->language, "rapid");
}

TEST(RapidLanguage, MakesOneConstantOfATargetThatIsWrittenOut) {
  const Parsed sut =
      parse(main_with(fmt::format("MoveL [[1,-2,3],[0.70711,0,0,0.70711],[0,0,0,0],{}],v100,z10,tool0;", kNone9)));
  ASSERT_TRUE(sut.program) << sut.findings.text();
  const auto* const move = first<MoveStatement>(*sut.program);
  ASSERT_NE(move, nullptr);
  const Pose& X = std::get<Pose>(constant(*sut.program, move->target));
  EXPECT_NEAR(X.translation().y(), -0.002, 1e-15);
  EXPECT_NEAR(X.linear()(1, 0), 1, 1e-15);  // a quarter of a turn about z
  EXPECT_NEAR((X.linear() * X.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-15);
  const auto* const speed = first<SetStatement>(*sut.program);
  EXPECT_EQ(speed->setting, Setting::linear_velocity);
  EXPECT_DOUBLE_EQ(std::get<double>(constant(*sut.program, speed->value)), 0.1);
}

TEST(RapidLanguage, KeepsAxesInDegreesAndMillimetres) {
  const Parsed sut = parse(main_with(fmt::format("MoveAbsJ [[1,2,3,4,9E9,9E9],{}],vmax,fine,tool0;", kNone9)));
  ASSERT_TRUE(sut.program) << sut.findings.text();
  const auto& joints = std::get<JointPosition>(constant(*sut.program, first<MoveStatement>(*sut.program)->target));
  EXPECT_EQ(joints.count, 4);
  EXPECT_EQ(joints.units, JointUnits::degree_mm);
  EXPECT_EQ(joints.values[3], 4);
}

TEST(RapidLanguage, SetsTheToolOnlyWhereTheTcpMoves) {
  const auto sets_tool = [](const Parsed& parsed) {
    for (const Statement& statement : parsed.program->statements) {
      const auto* const set = std::get_if<SetStatement>(&statement);
      if (set != nullptr && set->setting == Setting::tool) return true;
    }
    return false;
  };
  const Parsed joints = parse(main_with(fmt::format("MoveAbsJ [[1,2,3,4,5,6],{}],vmax,fine,tool0;", kNone9)));
  ASSERT_TRUE(joints.program) << joints.findings.text();
  EXPECT_FALSE(sets_tool(joints));
  const Parsed pose = parse(main_with(fmt::format("MoveJ [[1,2,3],[1,0,0,0],[0,0,0,0],{}],vmax,fine,tool0;", kNone9)));
  ASSERT_TRUE(pose.program) << pose.findings.text();
  EXPECT_TRUE(sets_tool(pose));
}

TEST(RapidLanguage, WarnsOnceOfAxisConfigurations) {
  const std::string move = fmt::format("MoveJ [[1,2,3],[1,0,0,0],[-1,0,1,0],{}],vmax,fine,tool0;\n", kNone9);
  const Parsed sut = parse(main_with(move + move));
  ASSERT_TRUE(sut.program) << sut.findings.text();
  EXPECT_EQ(sut.findings.warnings(), 1U);
  EXPECT_EQ(sut.findings.all().front().place.line, 3);
}

TEST(RapidLanguage, PlacesStatementsAndErrors) {
  const Parsed good = parse("MODULE M\nPROC main()\n  Set do1; Set do2;\nENDPROC\nENDMODULE\n");
  ASSERT_TRUE(good.program) << good.findings.text();
  const Place second = good.program->place(2);  // behind the jump to the entry and the first one
  EXPECT_EQ(second.line, 3);
  EXPECT_EQ(second.column, 12);
  const Parsed bad = parse("MODULE M\r\nPROC main()\r\n  Set do1; Set dx;\r\nENDPROC\r\nENDMODULE\r\n");
  ASSERT_EQ(bad.findings.errors(), 1U) << bad.findings.text();
  EXPECT_EQ(bad.findings.all().front().place.file, "shelf/test.mod");
  EXPECT_EQ(bad.findings.all().front().place.line, 3);
  EXPECT_EQ(bad.findings.all().front().place.column, 16);
}

TEST(RapidLanguage, ReportsAllErrorsInOnePass) {
  std::string statements;
  for (int n = 0; n < 50; ++n) statements += fmt::format("MoveC p{};\n", n);
  const Parsed sut = parse(main_with(statements));
  EXPECT_FALSE(sut.program);
  EXPECT_EQ(sut.findings.errors(), 50U);
}

TEST(RapidLanguage, GivesTheValidPartOfAProgramWithErrors) {
  std::shared_ptr<const Program> part;
  ParseContext context{.file = "test.mod", .codes = {}};
  context.read_part = &part;
  Diagnostics findings;
  EXPECT_FALSE(rapid_language().parse(main_with("Set do1;\nNONSENSE 1;"), context, findings));
  ASSERT_TRUE(part);
  EXPECT_NE(first<OutputStatement>(*part), nullptr);
}

// Whatever is quadratic in the length takes minutes.
TEST(RapidLanguage, ReadsLongTexts) {
  constexpr int kMany = 100'000;
  std::string unknown;
  std::string nested;
  std::string comments = "n:=[";
  for (int n = 0; n < kMany; ++n) {
    unknown += fmt::format("call{};\n", n);
    nested += "IF 1=1 THEN\n";
    comments += "!%a\n1,\n";
  }
  EXPECT_EQ(parse(main_with(unknown)).findings.errors(), static_cast<std::size_t>(kMany));
  EXPECT_FALSE(parse(main_with(nested)).findings.ok());
  EXPECT_FALSE(parse(main_with(comments)).findings.ok());
  EXPECT_FALSE(parse(main_with("n:=" + std::string(kMany, '(') + ";")).findings.ok());
}

TEST(RapidLexer, SkipsTheHeaderAndCountsItsLines) {
  rapid::Lexer sut("%%%\n VERSION:1\n%%%\nMODULE m");
  EXPECT_TRUE(sut.at("MODULE"));
  EXPECT_EQ(sut.token().line, 4U);
  EXPECT_TRUE(sut.token().begins_line);
}

TEST(RapidLexer, TakesValuesOfListsOnlyWhereNothingFollows) {
  rapid::Lexer sut("-12.5E1 , 9E+09] -1+2,");
  EXPECT_EQ(sut.take_list_value(), -125);
  ASSERT_TRUE(sut.at(rapid::Sign::comma));
  sut.advance();
  EXPECT_EQ(sut.take_list_value(), 9e9);
  ASSERT_TRUE(sut.at(rapid::Sign::close_list));
  sut.advance();
  EXPECT_EQ(sut.take_list_value(), std::nullopt);
  EXPECT_TRUE(sut.at(rapid::Sign::minus));
}

TEST(RapidLexer, TellsWordsWithoutRegardToCase) {
  rapid::Lexer sut("MoveL \"a ! b\" ! %SCRIPT me\n:=");
  EXPECT_TRUE(sut.at("MOVEL"));
  sut.advance();
  EXPECT_EQ(sut.token().kind, rapid::TokenKind::text);
  sut.advance();
  EXPECT_TRUE(sut.at(rapid::Sign::becomes));
  ASSERT_EQ(sut.scripts().size(), 1U);
  EXPECT_EQ(sut.scripts().front().text, "SCRIPT me");
  EXPECT_EQ(sut.scripts().front().line, 1U);
}

}  // namespace
