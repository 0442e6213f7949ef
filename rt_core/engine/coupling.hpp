// Master and slave: joints of a robot that follow joints of another (MASTER_SLAVE, manual 1.2.4).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::engine {

struct CoupledJoint {
  std::uint8_t master_joint = 0;
  std::uint8_t slave_joint = 0;
};

// Of one slave. A coupled joint follows to the master's value, not faster than the slave's own velocity limit and not
// beyond its range; the slave's other joints stay free.
struct Coupling {
  std::uint8_t master = 0;  // slots
  std::uint8_t slave = 0;
  std::uint8_t count = 0;
  std::array<CoupledJoint, kMaxJointsPerRobot> joints{};
  JointValues max_velocity{};  // rad/s or m/s, of the slave's joints
};

inline constexpr std::size_t kMaxCouplings = kMaxRobots;

}  // namespace cellmirror::engine
