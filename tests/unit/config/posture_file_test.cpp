#include "config/posture_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

// Robot "ARM" with LIFT (0..2 m), TURN and BEND (-2..1 rad), and a second one of the same kind.
struct PostureFile : testing::Test {
  PostureFile() {
    auto files = std::make_shared<TextFiles>();
    files->add("arm.mpc", kArm);
    Diagnostics findings;
    auto built = build_cell(
        "[[node]]\nname = \"A\"\nabstract = \"arm.mpc\"\n"
        "[[node]]\nname = \"B\"\nabstract = \"arm.mpc\"\nrobot_id = \"ARM_2\"\n",
        files, findings);
    EXPECT_TRUE(built) << findings.text();
    cell.emplace(std::move(*built));
  }

  struct Read {
    std::vector<std::vector<JointValues>> postures;
    std::uint64_t rows = 0;
    Diagnostics diagnostics;
  };
  Read read(const std::string& text) const {
    Read out;
    std::istringstream in(text);
    PostureReader sut(in, "p.csv", *cell, out.diagnostics);
    if (!sut.read_header()) return out;
    for (std::vector<JointValues> q = cell->start_positions(); sut.read_row(q);) out.postures.push_back(q);
    sut.finish();
    out.rows = sut.rows();
    return out;
  }
  std::string finding(const std::string& text) const {
    const Read out = read(text);
    EXPECT_EQ(out.diagnostics.all().size(), 1U) << out.diagnostics.text();
    EXPECT_FALSE(out.diagnostics.ok());
    return out.diagnostics.all().empty() ? "" : out.diagnostics.all()[0].text();
  }
  const JointValues& of(const std::vector<JointValues>& q, const char* robot) const {
    return q.at(cell->robot(robot)->slot());
  }

  std::optional<Cell> cell;
};

TEST_F(PostureFile, takesColumnsInAnyOrderAndLeavesTheOthersAtTheirStart) {
  const Read sut = read("ARM.BEND,ARM_2.TURN,ARM.LIFT\n-1.5,0.25,1\n0.5,-0.25,2\n");
  ASSERT_TRUE(sut.diagnostics.ok()) << sut.diagnostics.text();
  ASSERT_EQ(sut.postures.size(), 2U);
  EXPECT_EQ(of(sut.postures[0], "ARM")[0], 1.0);
  EXPECT_EQ(of(sut.postures[0], "ARM")[1], 0.0);
  EXPECT_EQ(of(sut.postures[0], "ARM")[2], -1.5);
  EXPECT_EQ(of(sut.postures[0], "ARM_2")[1], 0.25);
  EXPECT_EQ(of(sut.postures[1], "ARM_2")[1], -0.25);
  EXPECT_EQ(of(sut.postures[1], "ARM_2")[0], 0.0);
}

TEST_F(PostureFile, takesWhatSpreadsheetsWrite) {
  for (const char* text : {
           "\xEF\xBB\xBF\"ARM.LIFT\",\"ARM.TURN\"\r\n\"0.5\", 1e-1 \r\n",
           "# made by hand\nARM.LIFT , ARM.TURN\n# the first\n+.5,\t0.1\n\n \r\n",
           "ARM.LIFT,ARM.TURN\n0.5,0.1",
       }) {
    const Read sut = read(text);
    ASSERT_TRUE(sut.diagnostics.all().empty()) << text << sut.diagnostics.text();
    ASSERT_EQ(sut.postures.size(), 1U) << text;
    EXPECT_EQ(of(sut.postures[0], "ARM")[0], 0.5);
    EXPECT_EQ(of(sut.postures[0], "ARM")[1], 0.1);
  }
}

TEST_F(PostureFile, tellsEveryMistakeOfTheHeaderWithItsPlace) {
  const Read sut = read("ARN.LIFT,ARM.LFT,LIFT,,ARM.TURN,\"ARM.TURN\"\n1,2,3,4,5,6\n");
  EXPECT_TRUE(sut.postures.empty());
  ASSERT_EQ(sut.diagnostics.errors(), 5U) << sut.diagnostics.text();
  const std::string text = sut.diagnostics.text();
  EXPECT_THAT(text, HasSubstr("p.csv:1:1: error: "));
  EXPECT_THAT(text, HasSubstr("ARN"));
  EXPECT_THAT(text, HasSubstr("p.csv:1:10: error: robot ARM has no joint LFT; did you mean LIFT?"));
  EXPECT_THAT(text, HasSubstr("p.csv:1:18: error: LIFT is not robot.joint; e.g. ARM.LIFT"));
  EXPECT_THAT(text, HasSubstr("p.csv:1:23: error: a column without a name"));
  EXPECT_THAT(text, HasSubstr("p.csv:1:33: error: ARM.TURN appears twice; first in column 24"));
}

TEST_F(PostureFile, tellsEveryMistakeOfTheRowsInOnePass) {
  const Read sut = read("ARM.LIFT,ARM.TURN\n1\n1,2,3\nx,nan\n,1\n1,inf\n1e7,1\n1,\"2\n1,\"2\"3\n0,0\n");
  const std::string text = sut.diagnostics.text();
  EXPECT_EQ(sut.diagnostics.errors(), 9U) << text;
  EXPECT_EQ(sut.rows, 9U) << "wrong rows count";
  EXPECT_THAT(text, HasSubstr("p.csv:2:2: error: 1 columns, the header has 2"));
  EXPECT_THAT(text, HasSubstr("p.csv:3:5: error: 3 columns, the header has 2"));
  EXPECT_THAT(text, HasSubstr("p.csv:4:1: error: ARM.LIFT is not a finite number: x"));
  EXPECT_THAT(text, HasSubstr("p.csv:4:3: error: ARM.TURN is not a finite number: nan"));
  EXPECT_THAT(text, HasSubstr("p.csv:5:1: error: ARM.LIFT is empty"));
  EXPECT_THAT(text, HasSubstr("p.csv:6:3: error: ARM.TURN is not a finite number: inf"));
  EXPECT_THAT(text, HasSubstr("p.csv:7:1: error: ARM.LIFT is 1e+07 m; values must be within 1e+06"));
  EXPECT_THAT(text, HasSubstr("p.csv:8:3: error: the closing quote is missing"));
  EXPECT_THAT(text, HasSubstr("p.csv:9:6: error: text after the closing quote: 3"));
}

TEST_F(PostureFile, warnsOnceAColumnOfValuesBeyondARange) {
  const Read sut = read("ARM.LIFT,ARM.BEND\n2.5,0\n-1,0\n1,-2.0000000001\n0,1.5\n");
  EXPECT_TRUE(sut.diagnostics.ok());
  EXPECT_EQ(sut.postures.size(), 4U) << "a real robot may stand there";
  EXPECT_EQ(of(sut.postures[0], "ARM")[0], 2.5);
  ASSERT_EQ(sut.diagnostics.warnings(), 2U);
  EXPECT_EQ(sut.diagnostics.all()[0].text(),
            "p.csv:2:1: warning: ARM.LIFT is 2.5 m, beyond its range 0 .. 2; so in 2 rows; it is used as given");
  EXPECT_EQ(sut.diagnostics.all()[1].text(),
            "p.csv:5:3: warning: ARM.BEND is 1.5 rad, beyond its range -2 .. 1; it is used as given");
}

TEST_F(PostureFile, refusesWhatIsNoTableOfPostures) {
  EXPECT_THAT(finding(""), HasSubstr("p.csv: error: the file is empty; expected: a header of robot.joint columns"));
  EXPECT_THAT(finding("\n# only this\n\n"), HasSubstr("the file is empty"));
  EXPECT_THAT(finding("0.5,1\n1,2\n"), HasSubstr("p.csv:1:1: error: there is no header"));
  EXPECT_THAT(finding("ARM.LIFT\n"), HasSubstr("there is no posture below the header"));
  EXPECT_THAT(finding("ARM.LIFT\n1\n\n2\n"), HasSubstr("p.csv:3:1: error: a blank line between the rows"));
  EXPECT_THAT(finding(std::string(kLongestPostureLine + 1, 'x')), HasSubstr("is longer than 1048576 bytes"));
  std::string wide = "ARM.LIFT";
  for (std::size_t i = 0; i < kMaxPostureColumns; ++i) wide += ",ARM.TURN";
  EXPECT_THAT(finding(wide + "\n"), HasSubstr("more than 1024 columns"));
  EXPECT_THAT(finding(std::string("ARM.\0LIFT\n", 10)), HasSubstr("has no joint \\x00LIFT"));
}

TEST_F(PostureFile, keepsOfHostileTextsOnlyTheFirstFindings) {
  std::string text = "ARM.LIFT\n";
  for (int i = 0; i < 5000; ++i) text += "x\n";
  const Read sut = read(text);
  EXPECT_EQ(sut.diagnostics.errors(), 5000U);
  EXPECT_EQ(sut.diagnostics.all().size(), Diagnostics::kKept);
}

}  // namespace
}  // namespace cellmirror
