// Master and slave (manual 1.2.4): which joint follows which.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

namespace cellmirror {

// By their numbers in the two robots, from 0.
struct CoupledJoint {
  std::uint8_t master_joint = 0;
  std::uint8_t slave_joint = 0;
};

// As a command names them.
struct SlaveJoints {
  std::string_view robot;
  std::span<const std::pair<std::string_view, std::string_view>> joints;  // of the master, of the slave
};

}  // namespace cellmirror
