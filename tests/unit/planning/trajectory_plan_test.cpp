// What becomes of trajectories that a ROS 2 controller is commanded, and why some are refused.
#include "rt_core/planning/trajectory_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cellmirror::planning {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Nanoseconds ns(double seconds) { return Nanoseconds(std::llround(seconds * 1e9)); }

class TrajectoryPlanTest : public testing::Test {
 protected:
  void SetUp() override {
    parameters_.min_range.fill(-1);
    parameters_.max_range.fill(1);
    parameters_.max_velocity.fill(2);
    controller_.joints = {{.number = 0, .name = "a", .goal_tolerance = 0.1}, {.number = 2, .name = "c"}};
  }
  static JointTrajectory message_of(std::vector<std::string> joints, std::vector<TrajectoryPoint> points) {
    return {.start_wall_ns = {}, .joints = std::move(joints), .points = std::move(points)};
  }
  [[nodiscard]] auto plan(const JointTrajectory& message, const TrajectoryGoal* goal = nullptr) const {
    return plan_trajectory(controller_, {kinds_, parameters_}, message, goal, times_);
  }
  void expect_refused(const JointTrajectory& message, TrajectoryRefusal refusal, std::string_view text) const {
    const auto planned = plan(message);
    ASSERT_FALSE(planned.has_value());
    EXPECT_EQ(planned.error().refusal, refusal) << planned.error().text;
    EXPECT_NE(planned.error().text.find(text), std::string::npos) << planned.error().text;
  }

  std::vector<JointKind> kinds_ = {JointKind::revolute, JointKind::revolute, JointKind::prismatic};
  RobotParameters parameters_;
  TrajectoryController controller_;
  TrajectoryTimes times_{.now = Timestamp{10'000'000'000}};
};

TEST_F(TrajectoryPlanTest, PutsTheColumnsOfTheMessageToTheJointsOfTheRobot) {
  const auto planned = plan(message_of({"c", "a"}, {{{0.5, 0.25}, {}, {}, {}, ns(0)},
                                                    {{0.6, 0.3}, {0.1, 0.2}, {}, {}, ns(1)},
                                                    {{0.7, 0.4}, {0, 0}, {1, 2}, {}, ns(2.5)}}));
  ASSERT_TRUE(planned.has_value()) << planned.error().text;
  EXPECT_EQ(planned->joints, 3);
  EXPECT_EQ(planned->given, 0b101);
  EXPECT_EQ(planned->times, (std::vector<double>{0, 1, 2.5}));
  EXPECT_EQ(planned->orders, (std::vector{motion::KnotOrder::positions, motion::KnotOrder::velocities,
                                          motion::KnotOrder::accelerations}));
  EXPECT_EQ(planned->knot(0, 0).position, 0.25);
  EXPECT_EQ(planned->knot(1, 2).velocity, 0.1);
  EXPECT_EQ(planned->knot(2, 0).acceleration, 2);
  EXPECT_EQ(planned->max_velocity[2], 2);
  EXPECT_EQ(planned->goal_tolerance[0], 0.1);
}

TEST_F(TrajectoryPlanTest, RefusesJointsThatDoNotFit) {
  const std::vector<TrajectoryPoint> two = {{{0, 0}, {}, {}, {}, ns(1)}};
  expect_refused(message_of({"a", "x"}, two), TrajectoryRefusal::joints, "no joint x");
  expect_refused(message_of({"a", "a"}, two), TrajectoryRefusal::joints, "twice");
  expect_refused(message_of({"a"}, {{{0}, {}, {}, {}, ns(1)}}), TrajectoryRefusal::joints, "joint c is missing");
  expect_refused(message_of({}, {{{}, {}, {}, {}, ns(1)}}), TrajectoryRefusal::joints, "no joint");
  controller_.allow_partial = true;
  const auto planned = plan(message_of({"c"}, {{{0.5}, {}, {}, {}, ns(1)}}));
  ASSERT_TRUE(planned.has_value());
  EXPECT_EQ(planned->given, 0b100);
}

TEST_F(TrajectoryPlanTest, RefusesPointsThatAreNotSound) {
  const auto one = [](TrajectoryPoint point) { return message_of({"a", "c"}, {std::move(point)}); };
  expect_refused(one({{0}, {}, {}, {}, ns(1)}), TrajectoryRefusal::sizes, "1 positions for 2 joints");
  expect_refused(one({{0, 0}, {0}, {}, {}, ns(1)}), TrajectoryRefusal::sizes, "velocities");
  expect_refused(one({{0, 0}, {}, {0, 0, 0}, {}, ns(1)}), TrajectoryRefusal::sizes, "accelerations");
  expect_refused(one({{}, {0, 0}, {}, {}, ns(1)}), TrajectoryRefusal::no_positions, "point 1");
  expect_refused(one({{0, kNaN}, {}, {}, {}, ns(1)}), TrajectoryRefusal::not_finite, "positions of c in point 1");
  expect_refused(one({{0, 0}, {0, HUGE_VAL}, {}, {}, ns(1)}), TrajectoryRefusal::not_finite, "velocities");
  expect_refused(one({{0, 0}, {}, {1e300, 0}, {}, ns(1)}), TrajectoryRefusal::not_finite, "too large");
  expect_refused(one({{0, 0}, {0.5, 0}, {}, {}, ns(1)}), TrajectoryRefusal::end_velocity, "0.5");
  expect_refused(one({{0, 0}, {}, {}, {}, ns(-1)}), TrajectoryRefusal::times, "-1.000 s");
}

TEST_F(TrajectoryPlanTest, RefusesTimesThatRunBackwards) {
  for (const double second : {0.5, 1.0}) {
    expect_refused(message_of({"a", "c"}, {{{0, 0}, {}, {}, {}, ns(1)}, {{0, 0}, {}, {}, {}, ns(second)}}),
                   TrajectoryRefusal::times, "point 2");
  }
}

TEST_F(TrajectoryPlanTest, RefusesWhatHasEnded) {
  const JointTrajectory message = message_of({"a", "c"}, {{{0, 0}, {}, {}, {}, ns(1)}});
  times_.start = times_.now - ns(1.5);
  expect_refused(message, TrajectoryRefusal::past, "0.500 s ago");
  times_.start = times_.now - ns(0.5);
  EXPECT_TRUE(plan(message).has_value()) << "it has begun, and goes on";
}

TEST_F(TrajectoryPlanTest, RefusesPointsBeyondTheRange) {
  expect_refused(message_of({"a", "c"}, {{{0, 1.01}, {}, {}, {}, ns(1)}}), TrajectoryRefusal::beyond_range,
                 "c would be at 1.01 after 1.000 s, beyond its range -1 to 1");
}

// Both points are within the range, and the cubic between them is not: 0.9 at the middle would be 0.9 + T v / 4.
TEST_F(TrajectoryPlanTest, RefusesPolynomialsThatSwingBeyondTheRange) {
  const auto swing = [](double velocity) {
    return message_of({"a", "c"}, {{{0.9, 0}, {velocity, 0}, {}, {}, ns(1)},
                                   {{0.9, 0}, {-velocity, 0}, {}, {}, ns(2)},
                                   {{0.9, 0}, {0, 0}, {}, {}, ns(5)}});
  };
  EXPECT_TRUE(plan(swing(0.39)).has_value());
  expect_refused(swing(0.41), TrajectoryRefusal::beyond_range, "a would be at 1.0");
}

TEST_F(TrajectoryPlanTest, AGoalsTolerancesReplaceTheControllers) {
  const JointTrajectory message = message_of({"a", "c"}, {{{0, 0}, {}, {}, {}, ns(1)}});
  controller_.goal_time = 3;
  TrajectoryGoal goal;
  goal.path = {{.joint = "c", .position = 0.2}};
  goal.goal = {{.joint = "a", .position = -1, .velocity = 0.7}};
  auto planned = plan(message, &goal);
  ASSERT_TRUE(planned.has_value());
  EXPECT_EQ(planned->path_tolerance[2], 0.2);
  EXPECT_EQ(planned->goal_tolerance[0], 0) << "below 0: none";
  EXPECT_EQ(planned->stopped_velocity[0], 0.7);
  EXPECT_EQ(planned->goal_time, 3);
  goal.goal_time = ns(-1);
  EXPECT_EQ(plan(message, &goal)->goal_time, 0);
  goal.path[0].joint = "x";
  EXPECT_EQ(plan(message, &goal).error().refusal, TrajectoryRefusal::joints);
}

TEST_F(TrajectoryPlanTest, TakesTheLongestTrajectoryAndNoLonger) {
  JointTrajectory message = message_of({"a", "c"}, {});
  for (std::size_t i = 0; i < kMaxTrajectoryPoints; ++i)
    message.points.push_back({{0, 0}, {}, {}, {}, ns(0.001 * static_cast<double>(i + 1))});
  EXPECT_TRUE(plan(message).has_value());
  message.points.push_back({{0, 0}, {}, {}, {}, ns(100)});
  expect_refused(message, TrajectoryRefusal::too_many_points, "10001 points");
}

}  // namespace
}  // namespace cellmirror::planning
