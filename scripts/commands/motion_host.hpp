// Motion commands of SCRIPT: POS_ROB (manual 1.2.1), and our own MOVE_ROB, STOP_ROB and rob_positioning. Every call
// comes from the thread that owns the cell. SI. A refusal has a reason and a remedy; a refused call moves nothing.
#pragma once

#include <cstdint>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/motion_target.hpp"
#include "scripts/commands/activity.hpp"

namespace cellmirror {

enum class Positioning : std::uint8_t { moving, jumping };  // rob_positioning move, jump

class MotionHost {
 public:
  virtual ~MotionHost() = default;
  // POS_ROB: replaces the running move. The activity ends when the robot has arrived; null if it is there at once.
  virtual Result<ActivityHandle> position(std::string_view robot, const MotionTarget& target) = 0;
  // MOVE_ROB: behind what the robot does.
  virtual Result<void> queue_move(std::string_view robot, MovePath path, const MotionTarget& target) = 0;
  // STOP_ROB: brakes, and forgets what waits.
  virtual Result<void> stop(std::string_view robot) = 0;
  // rob_positioning, of the active robot.
  virtual Result<void> set_positioning(Positioning positioning) = 0;
  // True while any robot moves or has moves waiting.
  [[nodiscard]] virtual bool moving() const = 0;
};

}  // namespace cellmirror
