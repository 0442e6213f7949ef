// Motion commands of SCRIPT: POS_ROB (manual 1.2.1), and our own MOVE_ROB, STOP_ROB and rob_positioning. Every call
// comes from the thread that owns the cell. SI. A refusal has a reason and a remedy; a refused call moves nothing.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "scripts/commands/activity.hpp"

namespace cellmirror {

enum class TargetMode : std::uint8_t {
  joint_abs,
  joint_inc,
  frame_abs,
  frame_inc,
  tool_inc,
  screen_inc,
  start_position,      // rob_jnt_start_pos; MOVE_ROB only
  reference_position,  // rob_jnt_ref_pos; MOVE_ROB only
};
// "JOINT_ABS", ..., "START", "REFERENCE".
[[nodiscard]] std::string_view name_of(TargetMode mode);

struct MotionTarget {
  TargetMode mode = TargetMode::joint_abs;
  // joint_abs, joint_inc: rad or m; of the first joints, the others stay.
  std::span<const double> joints;
  // frame_abs: X_ZT, the TCP in the robot's ZP frame. frame_inc, tool_inc, screen_inc: a translation and a rotation in
  // the axes of the ZP frame, of the TCP, or of the screen.
  Pose pose = Pose::Identity();
};

enum class MovePath : std::uint8_t { joints, linear };      // PTP, LIN
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
