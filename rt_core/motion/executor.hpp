// Carries out the moves of one robot, tick by tick. Belongs to the tick thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/move.hpp"

namespace cellmirror::motion {

inline constexpr std::size_t kMoveQueue = 32;  // moves that wait, of each robot

enum class Outcome : std::uint8_t {
  none,
  arrived,
  stopped,     // by command
  superseded,  // by a newer move
  blocked,     // a linear move whose next step could not be met: the robot braked where it was
};

struct MotionState {
  bool moving = false;
  std::uint8_t waiting = 0;         // moves in the queue
  std::uint32_t running = 0;        // id of the move that runs; 0: none
  std::uint32_t finished = 0;       // the newest id that ended, however
  Outcome outcome = Outcome::none;  // of `finished`
};

}  // namespace cellmirror::motion
