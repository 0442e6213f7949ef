// How contacts deepen with joints: against the depth at a posture a little later.
#include "rt_core/collision/contact_rates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/collision/cell_of_bodies.hpp"

namespace cellmirror::collision {
namespace {

struct ContactRates : CellOfBodies {
  double depth_of(const std::string& body) {
    for (const TouchingPair& pair : check().touching) {
      if ((*table->names)[pair.a] == body || (*table->names)[pair.b] == body) return pair.depth_m;
    }
    ADD_FAILURE() << body << " touches nothing";
    return 0;
  }
  RobotContacts contacts(const std::string& robot) {
    return robot_contacts(*compiled, poses, *table, check(), cell->robot(robot)->slot());
  }
};

TEST_F(ContactRates, OfALinearAxis) {
  build(R"(
[[node]]
name = "Sledge"
abstract = "sledge.mpc"
[[node]]
name = "Wall"
xyz_m = [1.5, 0.0, 0.0]
geometry = [{ name = "wall", box_m = [1.0, 4.0, 4.0] }]
)");
  adopt();
  joint("SLEDGE", 0) = 0.95;
  const RobotContacts found = contacts("SLEDGE");
  ASSERT_EQ(found.count, 1U);
  EXPECT_NEAR(found.rates[0][0], 1, 1e-9);
  joint("SLEDGE", 0) = 0.5;
  EXPECT_EQ(contacts("SLEDGE").count, 0U);
}

// A ball in the way of the wrist: each joint's rate is the change of the depth with it.
TEST_F(ContactRates, OfAnArm) {
  build(R"(
[[node]]
name = "Arm"
abstract = "arm.mpc"
[[node]]
name = "Ball"
xyz_m = [0.92, 0.36, 1.12]
geometry = [{ name = "ball", sphere_m = 0.1 }]
)");
  adopt();
  joint("ARM", 0) = 0.4;
  joint("ARM", 1) = 0.8;
  joint("ARM", 2) = 0.6;
  const RobotContacts found = contacts("ARM");
  ASSERT_EQ(found.count, 1U);
  const std::string wrist = "Arm.J_1.J_2.J_3.J_4";
  for (std::size_t i = 0; i < 4; ++i) {
    constexpr double kStep = 1e-5;
    const double before = joint("ARM", i);
    joint("ARM", i) = before + kStep;
    const double above = depth_of(wrist);
    joint("ARM", i) = before - kStep;
    const double below = depth_of(wrist);
    joint("ARM", i) = before;
    EXPECT_NEAR(found.rates[0][i], (above - below) / (2 * kStep), 1e-4) << "joint " << i;
  }
  EXPECT_GT(std::abs(found.rates[0][1]), 0.1);
  EXPECT_NEAR(found.rates[0][3], 0, 1e-9) << "turns the ball about itself";
}

TEST_F(ContactRates, OfTwoRobots) {
  build(R"(
[[node]]
name = "Sledge"
abstract = "sledge.mpc"
[[node]]
name = "Other"
abstract = "sledge.mpc"
robot_id = "OTHER"
xyz_m = [1.0, 0.0, 0.0]
)");
  adopt();
  joint("SLEDGE", 0) = 0.9;
  const auto of_first = contacts("SLEDGE");
  const auto of_second = contacts("OTHER");
  ASSERT_EQ(of_first.count, 1U);
  ASSERT_EQ(of_second.count, 1U);
  EXPECT_NEAR(of_first.rates[0][0], 1, 1e-9);
  EXPECT_NEAR(of_second.rates[0][0], -1, 1e-9);
}

}  // namespace
}  // namespace cellmirror::collision
