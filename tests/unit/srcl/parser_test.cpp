#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "scripts/programs/srcl/srcl.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::program;

struct Parsed {
  std::shared_ptr<const Program> program;
  Diagnostics findings;
};

Parsed parse(std::string_view text) {
  Parsed parsed;
  parsed.program = srcl_language().parse(text, {"shelf/test.src", {}}, parsed.findings);
  return parsed;
}

const double* number(const Program& program, ExpressionId id) {
  return std::get_if<double>(&program.constants[program.expressions[id].payload]);
}

TEST(SrclLanguage, IsInTheRegistersForm) {
  const Language& sut = srcl_language();
  EXPECT_EQ(sut.name, "srcl");
  EXPECT_EQ(sut.extensions.front(), ".src");
  EXPECT_TRUE(sut.codes_file.empty());
}

TEST(SrclLanguage, NamesAProgramAfterItsHeaderOrItsFile) {
  EXPECT_EQ(parse("PROGRAMM Holen\n").program->name, "Holen");
  EXPECT_EQ(parse("PTP STELLUNG(1)\n").program->name, "test");
  EXPECT_EQ(parse("").program->language, "srcl");
}

TEST(SrclLanguage, ComputesSettingsInSi) {
  const Parsed sut = parse("V_BAHN 250\nV_ACHSE 50\nUEBER_WINKEL 180\n");
  ASSERT_TRUE(sut.program) << sut.findings.text();
  const auto value = [&sut](std::size_t i) {
    return *number(*sut.program, std::get<SetStatement>(sut.program->statements[i]).value);
  };
  EXPECT_DOUBLE_EQ(value(0), 0.25);
  EXPECT_DOUBLE_EQ(value(1), 0.5);
  EXPECT_DOUBLE_EQ(value(2), 3.14159265358979323846);
}

TEST(SrclLanguage, MakesOneConstantOfAPoseThatIsWrittenOut) {
  const Parsed sut = parse("LIN LAGE(1, -2, 3, 0, 0, 90)\n");
  ASSERT_TRUE(sut.program) << sut.findings.text();
  ASSERT_EQ(sut.program->expressions.size(), 1U);
  const Pose& X = std::get<Pose>(sut.program->constants.front());
  EXPECT_NEAR(X.translation().y(), -0.002, 1e-15);
  EXPECT_NEAR(X.linear()(1, 0), 1, 1e-15);
}

TEST(SrclLanguage, KeepsPlacesAndCallsStepsByTheirLabels) {
  const Parsed sut = parse("\n  PTP STELLUNG(1)\nM1: PTP STELLUNG(2)\n");
  ASSERT_TRUE(sut.program) << sut.findings.text();
  EXPECT_EQ(sut.program->place(0).line, 2);
  EXPECT_EQ(sut.program->place(0).column, 3);
  EXPECT_EQ(sut.program->step_name(0), "line 2");
  EXPECT_EQ(sut.program->step_name(1), "M1");
}

TEST(SrclLanguage, KeepsTheTextOfConditionsForPeople) {
  const Parsed sut = parse("WARTE BIS EINGANG( 3 ) UND  WAHR HOECHSTENS 5 ; soon\n");
  ASSERT_TRUE(sut.program) << sut.findings.text();
  const auto& wait = std::get<WaitStatement>(sut.program->statements.front());
  EXPECT_EQ(sut.program->texts[wait.text], "EINGANG( 3 ) UND  WAHR");
}

TEST(SrclLanguage, TellsAllFaultsInTheOrderOfTheLines) {
  const Parsed sut = parse("SPRUNG X\nRUF Y\nPTB Z\nGANZ I = 1.5\n");
  EXPECT_FALSE(sut.program);
  ASSERT_EQ(sut.findings.errors(), 4U) << sut.findings.text();
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(sut.findings.all()[static_cast<std::size_t>(i)].place.line, i + 1);
    EXPECT_EQ(sut.findings.all()[static_cast<std::size_t>(i)].place.file, "shelf/test.src");
    EXPECT_FALSE(sut.findings.all()[static_cast<std::size_t>(i)].remedy.empty());
  }
  EXPECT_NE(sut.findings.text().find("PTP"), std::string::npos);
}

TEST(SrclLanguage, ReadsALongProgram) {
  std::string text = "GANZ I\n";
  constexpr std::size_t kLines = 100'000;
  for (std::size_t i = 0; i < kLines; ++i) text += fmt::format("M{}: LIN LAGE({}, 0, 1.5) UEBER ; on\n", i, i);
  const Parsed sut = parse(text);
  ASSERT_TRUE(sut.program) << sut.findings.text();
  EXPECT_EQ(sut.program->statements.size(), kLines);
}

TEST(SrclLanguage, CountsFaultsBeyondThoseThatAreKept) {
  std::string text;
  for (int i = 0; i < 50'000; ++i) text += fmt::format("GANZ N{}\nX{} = 1\nSPRUNG L{}\nRUF U{}\n", i, i, i, i);
  const Parsed sut = parse(text);
  EXPECT_FALSE(sut.program);
  EXPECT_EQ(sut.findings.errors(), 150'000U);
  EXPECT_EQ(sut.findings.all().size(), Diagnostics::kKept);
}

TEST(SrclLanguage, BoundsWhatTextMayAskFor) {
  EXPECT_FALSE(parse(std::string(kLargestProgramText + 1, ' ')).program);
  EXPECT_FALSE(parse("LISTE LAGE A(60000)\nLISTE LAGE B(60000)\n").program);
  EXPECT_FALSE(parse("LISTE GANZ A(-9223372036854775807:9223372036854775807)\n").program);
  EXPECT_FALSE(parse("REAL X\nX = " + std::string(100'000, '(')).program);
  EXPECT_FALSE(parse("REAL X\nX = " + std::string(100'000, '-') + "1\n").program);
  std::string sum = "REAL X\nX = X";
  for (int i = 0; i < 100'000; ++i) sum += "+X";
  EXPECT_FALSE(parse(sum).program);
}

TEST(SrclLanguage, ReadsNestedBlocksUpToTheBound) {
  const auto nested = [](int depth) {
    std::string text;
    for (int i = 0; i < depth; ++i) text += "SCHLEIFE\n";
    for (int i = 0; i < depth; ++i) text += "ENDE_SCHLEIFE\n";
    return text;
  };
  EXPECT_TRUE(parse(nested(64)).program);
  EXPECT_EQ(parse(nested(65)).findings.errors(), 1U);
  EXPECT_GE(parse(nested(100'000)).findings.errors(), 1U);
}

}  // namespace
