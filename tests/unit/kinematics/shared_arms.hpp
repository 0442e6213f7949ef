// The arms of ../shared/data/robots: their URDF, and the chain that our own reader makes of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "rt_core/cell/component.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror {

struct SharedArm {
  std::string id;
  std::string base;
  std::string tip;
  std::string urdf;  // the text
};

// Empty where the data is not on this machine. $CELLMIRROR_SHARED_DATA wins over <source>/../shared/data.
[[nodiscard]] std::vector<SharedArm> shared_arms();

// Throws where the text has findings: a test with a wrong text of its own.
[[nodiscard]] Component component_of_urdf(const std::string& text);
[[nodiscard]] kinematics::Chain chain_of_urdf(const std::string& text, const std::string& base, const std::string& tip);

// Within the limits, and within +-pi where there are none.
[[nodiscard]] JointValues random_posture(const kinematics::Chain& chain, std::mt19937_64& random);

// A tree of links L0, L1, ... of all kinds of joints without mimics, about and along any axis, as URDF. With
// `along_axes` the axes are x, y, z and their opposites, and the poses turn by quarters: where special cases are.
[[nodiscard]] std::string random_urdf(std::size_t links, bool along_axes, std::mt19937_64& random);

}  // namespace cellmirror
