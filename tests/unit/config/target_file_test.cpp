#include "config/target_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cellmirror {
namespace {

using testing::HasSubstr;

const std::string kHeader = "px,py,pz,qx,qy,qz,qw\n";

struct Read {
  std::optional<std::vector<Pose>> targets;
  Diagnostics diagnostics;
};

Read read(const std::string& text) {
  Read out;
  out.targets = parse_targets(text, "t.csv", out.diagnostics);
  return out;
}

// The one finding of a text that is refused.
std::string finding(const std::string& text) {
  const Read sut = read(text);
  EXPECT_FALSE(sut.targets.has_value());
  EXPECT_EQ(sut.diagnostics.all().size(), 1U) << sut.diagnostics.text();
  return sut.diagnostics.all().empty() ? "" : sut.diagnostics.all()[0].text();
}

TEST(TargetFile, GivesPosesInTheOrderOfTheRows) {
  const Read sut = read(kHeader + "0.5,-0.25,1e-1,0,0,0,1\n1,2,3,0,0,0.6,0.8\n");
  ASSERT_TRUE(sut.targets) << sut.diagnostics.text();
  ASSERT_EQ(sut.targets->size(), 2U);
  EXPECT_TRUE((*sut.targets)[0].translation().isApprox(Eigen::Vector3d(0.5, -0.25, 0.1)));
  EXPECT_TRUE((*sut.targets)[0].linear().isIdentity());
  // About z with cos(a/2) = 0.8: cos a = 0.28, sin a = 0.96.
  Eigen::Matrix3d R;
  R << 0.28, -0.96, 0, 0.96, 0.28, 0, 0, 0, 1;
  EXPECT_TRUE((*sut.targets)[1].linear().isApprox(R, 1e-15));
}

TEST(TargetFile, TakesWhatSpreadsheetsWrite) {
  const Read plain = read(kHeader + "1,2,3,0,0,0,1\n");
  for (const std::string& text :
       {std::string("\xEF\xBB\xBFpx,py,pz,qx,qy,qz,qw\r\n1,2,3,0,0,0,1\r\n"), kHeader + "1,2,3,0,0,0,1",
        kHeader + " 1 ,\t2, +3 ,0,0,0,1\n\n  \n\r\n", std::string("PX, PY,PZ,qx,qy,qz,qw\n1,2,3,0,0,0,1\n"),
        kHeader + "1,2,3,0,0,0,1.0009\n"}) {
    const Read sut = read(text);
    ASSERT_TRUE(sut.targets) << text << sut.diagnostics.text();
    ASSERT_EQ(sut.targets->size(), 1U);
    EXPECT_TRUE((*sut.targets)[0].isApprox((*plain.targets)[0], 1e-15));
  }
}

TEST(TargetFile, NormalisesAQuaternionOfFewDigits) {
  const Read sut = read(kHeader + "0,0,0,0.5003,0.5,0.5,0.5\n");
  ASSERT_TRUE(sut.targets);
  const Eigen::Matrix3d R = (*sut.targets)[0].linear();
  EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
  EXPECT_TRUE((R * R.transpose()).isIdentity(1e-14));
}

TEST(TargetFile, SaysWhichRowIsBrokenAndWhere) {
  EXPECT_EQ(finding(kHeader + "1,2,3,0,0,0,1\n1,2,3,0,0,1\n"),
            "t.csv:3:12: error: 6 columns, 7 are expected; the columns are px,py,pz,qx,qy,qz,qw");
  EXPECT_EQ(finding(kHeader + "1,2,3,0,0,0,1,9\n"),
            "t.csv:2:15: error: 8 columns, 7 are expected; the columns are px,py,pz,qx,qy,qz,qw");
  EXPECT_EQ(finding(kHeader + "1,2, abc,0,0,0,1\n"), "t.csv:2:6: error: pz is not a finite number: abc");
  EXPECT_EQ(finding(kHeader + "1,,3,0,0,0,1\n"), "t.csv:2:3: error: py is empty");
  EXPECT_EQ(finding(kHeader + "1,2,nan,0,0,0,1\n"), "t.csv:2:5: error: pz is not a finite number: nan");
  EXPECT_THAT(finding(kHeader + "1,2,3,0,0,inf,1\n"), HasSubstr("t.csv:2:11: error: qz is not a finite number"));
  EXPECT_THAT(finding(kHeader + "1e7,2,3,0,0,0,1\n"), HasSubstr("t.csv:2:1: error: px is 1e+07 m away"));
}

TEST(TargetFile, RefusesAQuaternionThatIsNoRotation) {
  EXPECT_THAT(finding(kHeader + "1,2,3,0,0,0,1.2\n"),
              HasSubstr("t.csv:2:7: error: the quaternion's norm is 1.2, not 1"));
  EXPECT_THAT(finding(kHeader + "1,2,3,0,0,0,0\n"), HasSubstr("norm is 0"));
  EXPECT_THAT(finding(kHeader + "1,2,3,1e200,1e200,0,0\n"), HasSubstr("norm is inf"));
}

TEST(TargetFile, SaysWhatIsMissing) {
  EXPECT_THAT(finding(""), HasSubstr("the file is empty"));
  EXPECT_THAT(finding("\xEF\xBB\xBF\r\n\r\n"), HasSubstr("the file is empty"));
  EXPECT_THAT(finding(kHeader), HasSubstr("no target below the header"));
  EXPECT_THAT(finding("1,2,3,0,0,0,1\n"), HasSubstr("t.csv:1:1: error: there is no header"));
  EXPECT_THAT(finding("x,y,z,qx,qy,qz,qw\n1,2,3,0,0,0,1\n"), HasSubstr("this is not the header: x,y,z"));
  EXPECT_THAT(finding(kHeader + "1,2,3,0,0,0,1\n\n1,2,3,0,0,0,1\n"), HasSubstr("t.csv:3:1: error: a blank line"));
}

TEST(TargetFile, FindsEverythingInOnePass) {
  const Read sut = read("wrong\n1,2\n1,2,x,0,y,0,1\n\n1,2,3,0,0,0,2\n");
  EXPECT_FALSE(sut.targets);
  EXPECT_EQ(sut.diagnostics.errors(), 6U) << sut.diagnostics.text();
}

TEST(TargetFile, ShowsBytesThatNobodyCanRead) {
  using namespace std::string_literals;
  EXPECT_THAT(finding(kHeader + "1,2,\x01\xff\0,0,0,0,1\n"s), HasSubstr("\\x01\\xff\\x00"));
}

TEST(TargetFile, BoundsTheNumberOfTargets) {
  std::string text = kHeader;
  const std::string row = "1,2,3,0,0,0,1\n";
  text.reserve(row.size() * (kMaxTargets + 3));
  for (std::size_t i = 0; i < kMaxTargets; ++i) text += row;
  EXPECT_EQ(read(text).targets->size(), kMaxTargets);
  text += row + row;
  EXPECT_THAT(finding(text), HasSubstr("t.csv:1000002:1: error: more than 1000000 targets"));
}

}  // namespace
}  // namespace cellmirror
