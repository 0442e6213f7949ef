#include "app/io/range_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace cellmirror::app {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kOneDegree = std::numbers::pi / 180;

struct RangeWatchTest : testing::Test {
  RangeWatchTest() {
    robots[0].id = "ABB";
    robots[0].online = true;
    robots[0].joints.resize(2);
    robots[0].joints[0].name = "joint_1";
    robots[0].joints[1].name = "slide";
    robots[0].joints[1].kind = JointKind::prismatic;
    for (RobotJointState& joint : robots[0].joints) joint.state = DataState::fresh;
    pictures[0].parameters.min_range.fill(-110 * kOneDegree);
    pictures[0].parameters.max_range.fill(110 * kOneDegree);
    pictures[0].parameters.min_range[1] = 0;
    pictures[0].parameters.max_range[1] = 0.5;
  }
  std::vector<std::string> at(double position, double s) {
    robots[0].joints[0].position = position;
    return sut.look(Timestamp{1} + Nanoseconds(static_cast<std::int64_t>(s * 1e9)), robots, pictures);
  }
  std::vector<RobotState> robots = std::vector<RobotState>(1);
  std::vector<RobotSnapshot> pictures = std::vector<RobotSnapshot>(1);
  RangeWatch sut;
};

TEST_F(RangeWatchTest, TellsAJointOnceAnOccurrence) {
  EXPECT_THAT(at(110 * kOneDegree, 0), IsEmpty()) << "on the limit";
  EXPECT_THAT(
      at(-1596 * kOneDegree, 1),
      ElementsAre("joint_1 of ABB is at -1596.00 deg, beyond its range -110 .. 110 deg: see scale and sign of its "
                  "stream, and the model"));
  for (int i = 0; i < 100; ++i) EXPECT_THAT(at(-1500 * kOneDegree, 2 + i), IsEmpty());
  EXPECT_THAT(at(0, 110), IsEmpty());
  EXPECT_EQ(at(120 * kOneDegree, 111).size(), 1U);
}

TEST_F(RangeWatchTest, AJointThatSwingsAboutItsLimitIsToldAtMostOnceInTenSeconds) {
  std::size_t told = 0;
  for (int i = 0; i < 600; ++i) told += at(i % 2 == 0 ? 0 : 2, 0.05 * i).size();  // 30 s
  EXPECT_EQ(told, 3U);
}

TEST_F(RangeWatchTest, LooksAtFreshValuesOfMirroredRobotsOnly) {
  robots[0].joints[0].state = DataState::none;
  EXPECT_THAT(at(5, 0), IsEmpty());
  robots[0].joints[0].state = DataState::fresh;
  robots[0].online = false;
  EXPECT_THAT(at(5, 0), IsEmpty());
}

TEST_F(RangeWatchTest, TellsLengthsInMillimetres) {
  robots[0].joints[1].position = 0.75;
  EXPECT_THAT(at(0, 0), ElementsAre(testing::HasSubstr("slide of ABB is at 750.00 mm, beyond its range 0 .. 500 mm")));
}

}  // namespace
}  // namespace cellmirror::app
