// What the goldens do not show: places of statements, what is shared by all dialects, and how much is read how fast.
#include "scripts/programs/jet/teach_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/programs/jet/jet.hpp"
#include "scripts/programs/jet/teach_lines.hpp"
#include "scripts/programs/jet/teach_names.hpp"

namespace cellmirror::program {
namespace {

struct Reading {
  std::shared_ptr<const Program> program;
  Diagnostics findings;
};

Reading read(const Language& language, std::string_view text, const std::string& file = "programs/task.boom") {
  Reading reading;
  reading.program = language.parse(text, {file, {}}, reading.findings);
  return reading;
}

TEST(JetLanguages, SayWhatTheyAreCalled) {
  EXPECT_EQ(jet_boom_language().name, "jet_boom");
  EXPECT_EQ(jet_tarm_language().name, "jet_tarm");
  EXPECT_EQ(jet_boom_language().extensions.front(), ".boom");
  EXPECT_EQ(jet_tarm_language().extensions.front(), ".tarm");
}

TEST(TeachFile, MakesAReversibleProgram) {
  const Reading sut = read(jet_boom_language(), "JET_BOOM 1\nJOINTS 1\nPOINT P1 0\nEND\n");
  ASSERT_TRUE(sut.program) << sut.findings.text();
  EXPECT_TRUE(sut.program->reversible);
  EXPECT_EQ(sut.program->language, "jet_boom");
  EXPECT_EQ(sut.program->file, "programs/task.boom");
}

TEST(TeachFile, IsNamedByItsHeaderOrItsFile) {
  EXPECT_EQ(read(jet_boom_language(), "JET_BOOM 1\nJOINTS 1\nPOINT P1 0\nEND\n").program->name, "task");
  EXPECT_EQ(read(jet_boom_language(), "JET_BOOM 1\nNAME a.b\nJOINTS 1\nPOINT P1 0\nEND\n").program->name, "a.b");
  EXPECT_EQ(read(jet_boom_language(), "JET_BOOM 1\nJOINTS 1\nPOINT P1 0\nEND\n", "plain").program->name, "plain");
}

TEST(TeachFile, CallsStepsByTheirCheckPoints) {
  const Reading sut =
      read(jet_boom_language(), "JET_BOOM 1\nJOINTS 1\nSPEED 10\nPOINT A 0\n  DWELL 1\nPOINT B 1 SPEED 20\nEND\n");
  ASSERT_TRUE(sut.program) << sut.findings.text();
  ASSERT_EQ(sut.program->statements.size(), 5U);  // speed, A, dwell, speed, B
  EXPECT_EQ(sut.program->step_name(1), "check point A");
  EXPECT_EQ(sut.program->step_name(4), "check point B");
  EXPECT_EQ(sut.program->step_name(2), "line 5");
  EXPECT_EQ(sut.program->place(2).column, 3);
  // A setting belongs to the check point that it is for.
  EXPECT_EQ(sut.program->step_name(3), "check point B");
}

TEST(TeachFile, OfOneDialectIsNoProgramOfTheOther) {
  const std::string_view boom = "JET_BOOM 1\nJOINTS 1\nPOINT P1 0\nEND\n";
  EXPECT_TRUE(read(jet_boom_language(), boom).program);
  EXPECT_FALSE(read(jet_tarm_language(), boom).program);
}

TEST(TeachFile, GivesNoProgramWhereAnythingIsWrong) {
  const Reading sut = read(jet_boom_language(), "JET_BOOM 1\nJOINTS 1\nPOINT P1 0\nPOINT P2 x\nEND\n");
  EXPECT_FALSE(sut.program);
  ASSERT_EQ(sut.findings.errors(), 1U);
  EXPECT_EQ(sut.findings.all().front().place.line, 4);
  EXPECT_EQ(sut.findings.all().front().place.column, 10);
}

TEST(TeachFile, MayHaveAHundredThousandPoints) {
  std::string text = "JET_BOOM 1\nJOINTS 6\n";
  for (int i = 0; i < 100'000; ++i) text += fmt::format("POINT P{} {} 0.5 -12.25 800 {} 7\n", i, i % 90, i % 45);
  text += "END\n";
  const Reading sut = read(jet_boom_language(), text);
  ASSERT_TRUE(sut.program) << sut.findings.text();
  EXPECT_EQ(sut.program->statements.size(), 100'000U);
}

TEST(TeachFile, CountsFindingsThatItDoesNotKeep) {
  std::string text = "JET_BOOM 1\nJOINTS 1\n";
  for (int i = 0; i < 5'000; ++i) text += "NONSENSE\n";
  const Reading sut = read(jet_boom_language(), text);
  EXPECT_EQ(sut.findings.all().size(), Diagnostics::kKept);
  EXPECT_EQ(sut.findings.errors(), 5'002U);  // and END, and check points
}

TEST(TeachNames, BeginWithALetter) {
  EXPECT_TRUE(is_teach_name("P1"));
  EXPECT_TRUE(is_teach_name("a.b-c_D"));
  EXPECT_TRUE(is_teach_name(std::string(63, 'x')));
  for (const std::string& wrong : {std::string(), std::string("1P"), std::string("_a"), std::string("a b"),
                                   std::string("ä"), std::string("a="), std::string(64, 'x')})
    EXPECT_FALSE(is_teach_name(wrong)) << wrong;
}

TEST(TeachNamesTest, KnowTheLineOfEachName) {
  std::vector<std::string> names;
  for (int i = 0; i < 5'000; ++i) names.push_back(fmt::format("P{}", i));
  TeachNames sut;
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(sut.note(names[i], static_cast<int>(i) + 1), 0);
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(sut.note(names[i], 9'999), static_cast<int>(i) + 1);
  EXPECT_EQ(sut.note("p1", 7), 0) << "case counts";
}

TEST(TeachLinesTest, GiveWordsWithTheirColumns) {
  TeachLines sut("\n# only a comment\r\n  one\ttwo#three\n\n %  a # b \n");
  ASSERT_EQ(sut.next(), TeachLines::Line::words);
  EXPECT_EQ(sut.number(), 3);
  ASSERT_EQ(sut.words().size(), 2U);
  EXPECT_EQ(sut.words()[0].text, "one");
  EXPECT_EQ(sut.words()[0].column, 3);
  EXPECT_EQ(sut.words()[1].text, "two");
  EXPECT_EQ(sut.words()[1].column, 7);
  ASSERT_EQ(sut.next(), TeachLines::Line::script);
  EXPECT_EQ(sut.number(), 5);
  EXPECT_EQ(sut.column(), 2);
  EXPECT_EQ(sut.script().text, "a # b");
  EXPECT_EQ(sut.script().column, 5);
  EXPECT_EQ(sut.next(), TeachLines::Line::end);
}

}  // namespace
}  // namespace cellmirror::program
