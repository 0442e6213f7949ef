// What the owner of the cell tells the tick. Values are SI and were checked by the owner; the tick's limiter checks
// again.
#pragma once

#include <cstdint>

#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::engine {

enum class CommandKind : std::uint8_t {
  add_robot,      // slot, joint_count, values = positions, lower, upper
  remove_robot,   // slot
  set_mode,       // slot, mode, ages
  set_positions,  // slot, values; only while the robot is simulated
  set_limits,     // slot, lower, upper
};

struct Command {
  std::uint64_t id = 0;  // given by Engine::send(), ascending
  CommandKind kind = CommandKind::set_positions;
  std::uint8_t slot = 0;
  std::uint8_t joint_count = 0;
  RobotMode mode = RobotMode::simulated;
  StreamAges ages;
  JointValues values{};  // rad or m
  JointValues lower{};
  JointValues upper{};
};

}  // namespace cellmirror::engine
