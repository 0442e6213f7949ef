// The simulated motions against their closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "sim_devices/motion/motion_source.hpp"
#include "sim_devices/motion/motion_table.hpp"

namespace cellmirror::sim {
namespace {

using ::testing::HasSubstr;

std::array<JointValue, 2> values_at(const MotionSource& sut, double t_s) {
  std::array<JointValue, 2> values{};
  sut.at(t_s, values);
  return values;
}

class MotionFile {
 public:
  explicit MotionFile(const std::string& text) {
    std::string name = (std::filesystem::temp_directory_path() / "cellmirror_motion_XXXXXX").string();
    const int fd = mkstemp(name.data());
    if (fd >= 0) close(fd);
    path_ = name;
    std::ofstream(path_) << text;
  }
  ~MotionFile() { std::filesystem::remove(path_); }
  [[nodiscard]] std::string path() const { return path_; }

 private:
  std::string path_;
};

TEST(Motion, SineFollowsItsFormulaWithAStepFromJointToJoint) {
  const auto sut = make_motion("sine:amplitude=0.5,period=4,offset=0.1,phase=0.2,step=0.3", 2);
  ASSERT_TRUE(sut) << sut.error().text();
  for (const double t : {0.0, 0.7, 1.0, 123.456}) {
    const auto values = values_at(**sut, t);
    const double angle = 2 * std::numbers::pi / 4 * t + 0.2;
    EXPECT_NEAR(values[0].position, 0.1 + 0.5 * std::sin(angle), 1e-12);
    EXPECT_NEAR(values[1].position, 0.1 + 0.5 * std::sin(angle + 0.3), 1e-12);
    EXPECT_NEAR(values[0].velocity, 0.5 * 2 * std::numbers::pi / 4 * std::cos(angle), 1e-12);
  }
}

TEST(Motion, RampTellsItsTime) {
  const auto sut = make_motion("ramp:velocity=0.25,offset=-1", 2);
  ASSERT_TRUE(sut);
  EXPECT_DOUBLE_EQ(values_at(**sut, 8.0)[1].position, 1.0);
  EXPECT_DOUBLE_EQ(values_at(**sut, 8.0)[1].velocity, 0.25);
}

TEST(Motion, HoldStandsStill) {
  const auto sut = make_motion("hold:position=0.75", 2);
  ASSERT_TRUE(sut);
  EXPECT_DOUBLE_EQ(values_at(**sut, 5.0)[0].position, 0.75);
  EXPECT_DOUBLE_EQ(values_at(**sut, 5.0)[0].velocity, 0.0);
}

TEST(Motion, WaypointsRestAtEachRowAndAreHalfWayAtHalfTime) {
  const MotionFile file("time_s,q1,q2\n10,0,1\n12,1,3\n13,1,0\n");
  const auto sut = make_motion("waypoints:" + file.path(), 2);
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_DOUBLE_EQ(values_at(**sut, 0)[0].position, 0);
  EXPECT_DOUBLE_EQ(values_at(**sut, 1)[0].position, 0.5);
  EXPECT_DOUBLE_EQ(values_at(**sut, 1)[1].position, 2);
  // The largest speed of a minimum-jerk way is 15/8 of the mean one.
  EXPECT_DOUBLE_EQ(values_at(**sut, 1)[1].velocity, 15.0 / 8.0 * (3 - 1) / 2);
  EXPECT_DOUBLE_EQ(values_at(**sut, 2)[1].position, 3);
  EXPECT_DOUBLE_EQ(values_at(**sut, 2)[1].velocity, 0);
  // A quarter of the way in time: s = 1/4 gives 10/64 - 15/256 + 6/1024 = 106/1024.
  EXPECT_DOUBLE_EQ(values_at(**sut, 0.5)[0].position, 106.0 / 1024.0);
}

TEST(Motion, RecordedIsLinearAndBeginsAnew) {
  const MotionFile file("# a comment\n0;0;0\n\n1;2;4\n2;2;0\n");
  const auto sut = make_motion("recorded:" + file.path(), 2);
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_DOUBLE_EQ(values_at(**sut, 0.25)[0].position, 0.5);
  EXPECT_DOUBLE_EQ(values_at(**sut, 0.25)[1].velocity, 4);
  EXPECT_DOUBLE_EQ(values_at(**sut, 2.25)[0].position, 0.5);
}

TEST(Motion, OnceStaysAtTheLastRow) {
  const MotionFile file("0,0,0\n1,2,4\n");
  const auto sut = make_motion("recorded:" + file.path() + ",once", 2);
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_DOUBLE_EQ(values_at(**sut, 99)[1].position, 4);
  EXPECT_DOUBLE_EQ(values_at(**sut, 99)[1].velocity, 0);
}

TEST(Motion, RefusesWithTheRemedy) {
  EXPECT_THAT(make_motion("sinus", 1).error().text(), HasSubstr("motions: hold"));
  EXPECT_THAT(make_motion("sine:amplitud=1", 1).error().text(), HasSubstr("amplitude"));
  EXPECT_THAT(make_motion("sine:period=0", 1).error().text(), HasSubstr("above 0"));
  EXPECT_THAT(make_motion("sine:period=nan", 1).error().text(), HasSubstr("not a number"));
  EXPECT_THAT(make_motion("waypoints:", 1).error().text(), HasSubstr("FILE.csv"));
  EXPECT_FALSE(make_motion("recorded:/nonexistent/file.csv", 1));
  const MotionFile file("0,1\n1,2\n");
  EXPECT_THAT(make_motion("recorded:" + file.path(), 3).error().text(), HasSubstr("the robot has 3 joints"));
}

TEST(MotionTable, ShowsAllFindingsOfAFileInOnePass) {
  Diagnostics diagnostics;
  (void)read_motion_table("t,a\n0,1\n1,x\n0.5,2\n0.5,3\n2,1,2\n3,1e12\n", "f.csv", diagnostics);
  EXPECT_EQ(diagnostics.errors(), 4U) << diagnostics.text();
  EXPECT_THAT(diagnostics.text(), HasSubstr("f.csv:3:3"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("f.csv:5:1"));
}

TEST(MotionTable, RefusesAnEmptyFile) {
  Diagnostics diagnostics;
  (void)read_motion_table("time,q\n", "f.csv", diagnostics);
  EXPECT_FALSE(diagnostics.ok());
}

}  // namespace
}  // namespace cellmirror::sim
