// Two linear equations in the cosines and sines of two angles: what is left of an arm where nothing else separates the
// joints. Comes down to a quartic.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "rt_core/inverse_kinematics/closed_form_subproblems.hpp"

namespace cellmirror::inverse_kinematics::closed_form {

struct TurnPairs {
  std::array<Turn, 4> first;
  std::array<Turn, 4> second;
  std::size_t count = 0;
};

// A (c1, s1) + B (c2, s2) = k with B regular, of which `inverse` is the inverse. A pair that misses the second unit
// circle by at most `slack` counts as one. No pairs where every first angle is one.
TurnPairs solve_pair(const Eigen::Matrix2d& A, const Eigen::Matrix2d& inverse, const Eigen::Vector2d& k, double slack);

}  // namespace cellmirror::inverse_kinematics::closed_form
