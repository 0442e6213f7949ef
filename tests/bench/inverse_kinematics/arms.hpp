// The arms on which inverse kinematics is measured: those of the shared data, and others that it was not tuned for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::test_arms {

// For the time limits of searches.
inline const SystemClock kClock;

struct Arm {
  std::string name;
  kinematics::Chain chain;
};

// The arms of the shared data; empty where it is missing.
[[nodiscard]] std::vector<Arm> shared_arms();

// Known geometries that are not in the shared data, and arms with random offsets, prismatic joints, narrow limits and
// continuous joints: 4 to 8 joints.
[[nodiscard]] std::vector<Arm> unseen_arms();

// An arm of `joints` joints drawn from `seed`.
[[nodiscard]] Arm random_arm(std::size_t joints, std::uint64_t seed);

// Uniform in the ranges, continuous joints within one turn.
[[nodiscard]] std::vector<JointValues> random_postures(const kinematics::Chain& chain, std::size_t count,
                                                       std::uint64_t seed);

}  // namespace cellmirror::test_arms
