// The solver of constraints against closed forms of impulses.
#include "rt_core/tissue/contact/constraint_system.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cellmirror::tissue {
namespace {

using Eigen::Vector3d;

TEST(ConstraintSystem, a_particle_stops_at_a_plane_that_it_reaches_within_the_step) {
  ConstraintSystem system;
  system.clear();
  const auto node = system.node(0, 7, {0.3, 0, -2.0}, 1.0 / 0.5);
  system.add_term(node, 1.0);
  ConstraintSystem::Push push;
  push.bias = -0.5;  // 0.5 mm away: in a millisecond it may come nearer by as much
  const std::size_t number = system.add(push);
  system.solve(4);
  EXPECT_NEAR(system.velocity(0).z(), -0.5, 1e-12);
  EXPECT_NEAR(system.velocity(0).x(), 0.3, 1e-12) << "there is no friction";
  EXPECT_NEAR(system.push(number).impulse, 0.5 * 1.5, 1e-12);
}

TEST(ConstraintSystem, contacts_never_pull) {
  ConstraintSystem system;
  system.clear();
  system.add_term(system.node(0, 0, {0, 0, 1.0}, 2.0), 1.0);
  const std::size_t number = system.add(ConstraintSystem::Push{});
  system.solve(4);
  EXPECT_EQ(system.push(number).impulse, 0);
  EXPECT_EQ(system.velocity(0).z(), 1.0);
}

TEST(ConstraintSystem, friction_takes_at_most_its_coefficient_times_the_normal_impulse) {
  for (const double slide : {0.1, 5.0}) {
    ConstraintSystem system;
    system.clear();
    const double mass = 0.2;
    system.add_term(system.node(0, 0, {slide, 0, -1.0}, 1 / mass), 1.0);
    ConstraintSystem::Push push;
    push.friction = 0.3;
    const std::size_t number = system.add(push);
    system.solve(20);
    const double left = std::max(0.0, slide - 0.3 * 1.0);  // the normal impulse is mass * 1 m/s
    EXPECT_NEAR(system.velocity(0).x(), left, 1e-9);
    EXPECT_NEAR(system.push(number).tangential.x(), -mass * (slide - left), 1e-9);
  }
}

TEST(ConstraintSystem, a_point_between_nodes_moves_them_by_its_weights) {
  ConstraintSystem system;
  system.clear();
  const double w0 = 0.25;
  const double w1 = 0.75;
  const auto a = system.node(0, 0, Vector3d::Zero(), 4.0);
  const auto b = system.node(0, 1, Vector3d::Zero(), 10.0);
  system.add_term(a, w0);
  system.add_term(b, w1);
  ConstraintSystem::Push push;
  push.velocity = {0, 0, 1.0};  // an instrument that moves with 1 m/s along the normal
  const std::size_t number = system.add(push);
  system.solve(5);
  const double impulse = 1.0 / (w0 * w0 * 4.0 + w1 * w1 * 10.0);
  EXPECT_NEAR(system.push(number).impulse, impulse, 1e-12);
  EXPECT_NEAR(system.velocity(a).z(), 4.0 * w0 * impulse, 1e-12);
  EXPECT_NEAR(system.velocity(b).z(), 10.0 * w1 * impulse, 1e-12);
}

TEST(ConstraintSystem, two_bodies_keep_their_momentum) {
  ConstraintSystem system;
  system.clear();
  const auto a = system.node(0, 0, {0.2, 0, -1.0}, 1 / 0.3);
  const auto b = system.node(1, 0, {-0.1, 0, 0.4}, 1 / 0.7);
  const Vector3d before = 0.3 * Vector3d(0.2, 0, -1.0) + 0.7 * Vector3d(-0.1, 0, 0.4);
  system.add_term(a, 1.0);
  system.add_term(b, -1.0);
  ConstraintSystem::Push push;
  push.friction = 0.05;
  system.add(push);
  system.solve(20);
  const Vector3d after = 0.3 * system.velocity(a) + 0.7 * system.velocity(b);
  EXPECT_NEAR((after - before).norm(), 0, 1e-12);
  EXPECT_NEAR(system.velocity(a).z(), system.velocity(b).z(), 1e-12);
}

TEST(ConstraintSystem, what_is_held_follows_until_the_limit_of_force) {
  for (const double most : {1.0, 0.01}) {
    ConstraintSystem system;
    system.clear();
    system.add_term(system.node(0, 0, Vector3d::Zero(), 1 / 0.1), 1.0);
    ConstraintSystem::Hold hold;
    hold.velocity = {0.5, 0, 0};
    hold.most = most;
    const std::size_t number = system.add(hold);
    system.solve(5);
    const double impulse = std::min(most, 0.05);
    EXPECT_NEAR(system.hold(number).impulse.x(), impulse, 1e-12);
    EXPECT_NEAR(system.velocity(0).x(), impulse / 0.1, 1e-12);
    EXPECT_EQ(system.hold(number).limited, most < 0.05);
  }
}

// Implicit Euler of a spring and a damper: v = (v0 + dt k s / m) / (1 + dt (dt k + c) / m).
TEST(ConstraintSystem, a_soft_constraint_is_an_implicit_spring) {
  const double mass = 0.004;
  const double dt = 0.001;
  for (const double k : {10.0, 1e3, 1e7}) {
    const double c = 0.002 * k;
    const double stretch = 0.003;
    ConstraintSystem system;
    system.clear();
    system.add_term(system.node(0, 0, Vector3d::Zero(), 1 / mass), 1.0);
    ConstraintSystem::Push push;
    push.softness = 1 / (dt * (dt * k + c));
    push.bias = stretch * k / (dt * k + c);
    system.add(push);
    system.solve(40);
    EXPECT_NEAR(system.velocity(0).z(), dt * k * stretch / mass / (1 + dt * (dt * k + c) / mass), 1e-9);
  }
}

TEST(ConstraintSystem, immovable_nodes_take_no_velocity_and_report_the_impulse_of_others) {
  ConstraintSystem system;
  system.clear();
  const auto fixed = system.node(0, 0, Vector3d::Zero(), 0.0);
  const auto free = system.node(1, 3, {0, 0, 2.0}, 1 / 0.1);
  system.add_term(fixed, 1.0);
  system.add_term(free, -1.0);
  const std::size_t number = system.add(ConstraintSystem::Push{});
  system.solve(5);
  EXPECT_TRUE(system.movable(number));
  EXPECT_NEAR(system.velocity(free).z(), 0, 1e-12);
  EXPECT_EQ(system.velocity(fixed).z(), 0);
  EXPECT_NEAR(system.nodes()[fixed].impulse.z(), 0.2, 1e-12);
  system.clear();
  system.add_term(system.node(0, 0, Vector3d::Zero(), 0.0), 1.0);
  ConstraintSystem::Push push;
  push.velocity = {0, 0, 1};
  const std::size_t alone = system.add(push);
  system.solve(5);
  EXPECT_FALSE(system.movable(alone));
  EXPECT_EQ(system.push(alone).impulse, 0);
}

}  // namespace
}  // namespace cellmirror::tissue
