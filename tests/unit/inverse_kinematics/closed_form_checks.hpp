// What every test of the closed forms asks of the postures found.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "closed_form_arms.hpp"
#include "rt_core/inverse_kinematics/closed_form.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::inverse_kinematics::test {

using Found = std::vector<JointValues>;

inline Found solve(const ClosedForm& sut, const Pose& X_BG, const JointValues& near = {}) {
  std::array<JointValues, kMaxClosedForms> out;
  const std::size_t count = sut.solve(X_BG, out, near);
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count)};
}

// Largest component of the error twist: m, rad.
inline double error_of(const kinematics::Chain& chain, const JointValues& q, const Pose& X_BG) {
  return kinematics::pose_error(kinematics::forward(chain, q), X_BG).cwiseAbs().maxCoeff();
}

// Largest difference of a joint, modulo whole turns.
inline double distance(const JointValues& a, const JointValues& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2 * std::numbers::pi)));
  }
  return most;
}

inline double nearest_distance(const Found& found, const JointValues& q) {
  double least = std::numeric_limits<double>::infinity();
  for (const JointValues& p : found) least = std::min(least, distance(p, q));
  return least;
}

// Uniform within the turn for the chain's joints, zero behind them.
inline JointValues random_posture(const kinematics::Chain& chain, Random& random) {
  JointValues q{};
  for (double& value : std::span(q).first(chain.variable_count())) value = random.angle();
  return q;
}

// How far the posture is from singular ones: the smallest pivot of the Jacobian, about the speed of the tip (m/s,
// rad/s) that one unit of joint speed gives in the worst direction.
inline double dexterity(const kinematics::Chain& chain, const JointValues& q) {
  kinematics::Jacobian J;
  (void)kinematics::forward(chain, q, J);
  const Eigen::Matrix<double, 6, 6> JJt = J * J.transpose();
  return std::sqrt(std::max(0.0, JJt.ldlt().vectorD().minCoeff()));
}

struct Tally {
  std::size_t targets = 0;
  std::size_t lost = 0;     // the posture that made the target is not among those found
  std::size_t inexact = 0;  // postures off by more than 1e-9, within the slack of reach
  std::size_t wrong = 0;    // postures off by more than that
  std::size_t out_of_range = 0;
  std::size_t postures = 0;
};

// Targets from random postures: the posture itself has to be found again, and all that is found has to be right.
inline Tally try_random_targets(const ClosedForm& sut, const kinematics::Chain& chain, std::size_t targets,
                                unsigned seed) {
  constexpr double kSlack = 1e-4;  // 20 um at the elbow, as seen by all six components of a metre's arm
  Random random(seed);
  Tally tally;
  for (std::size_t k = 0; k < targets; ++k) {
    JointValues q = random_posture(chain, random);
    while (dexterity(chain, q) < 1e-4) q = random_posture(chain, random);
    const Pose X_BG = kinematics::forward(chain, q);
    const Found found = solve(sut, X_BG, q);
    ++tally.targets;
    tally.postures += found.size();
    tally.lost += nearest_distance(found, q) > 1e-6;
    for (const JointValues& p : found) {
      const double error = error_of(chain, p, X_BG);
      tally.inexact += error > 1e-9;
      tally.wrong += !(error <= kSlack);
      tally.out_of_range += std::ranges::any_of(
          p, [](double value) { return !(value > -std::numbers::pi && value <= std::numbers::pi); });
    }
  }
  return tally;
}

inline void expect_all_found(const ClosedForm& sut, const kinematics::Chain& chain, std::size_t targets,
                             unsigned seed) {
  const Tally tally = try_random_targets(sut, chain, targets, seed);
  EXPECT_EQ(tally.lost, 0U) << sut.family();
  EXPECT_EQ(tally.wrong, 0U) << sut.family();
  EXPECT_EQ(tally.out_of_range, 0U) << sut.family();
  // Only branches whose border runs within the 20 um of slack past the target: one in some tens of thousands.
  EXPECT_LE(tally.inexact, 2 + tally.postures / 5000) << sut.family();
}

}  // namespace cellmirror::inverse_kinematics::test
