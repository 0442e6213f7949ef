// The way from the motion service to the robots of the tick; tests put a fake in its place. Belongs to the thread that
// owns the cell.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/executor.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::app {

class MotionPort {
 public:
  virtual ~MotionPort() = default;
  // Refused: a robot that is not known, and one that is online.
  virtual Result<void> check_simulated(std::string_view robot) const = 0;
  // What the tick published last of a robot that is known.
  [[nodiscard]] virtual motion::MotionState motion(std::string_view robot) = 0;
  // Where all robots stand, by slot; rad or m.
  [[nodiscard]] virtual std::span<const JointValues> positions() = 0;

  // At once; what the robot does ends.
  virtual Result<void> jump(std::string_view robot, const JointValues& positions) = 0;
  // For the moves that are added from now on.
  virtual Result<void> set_chain(std::string_view robot, std::shared_ptr<const kinematics::Chain> chain) = 0;
  virtual Result<void> add_move(std::string_view robot, const motion::Move& move) = 0;
  virtual Result<void> stop_motion(std::string_view robot) = 0;
  // motion::MoveExecutor::set_pace().
  virtual Result<void> set_pace(std::string_view robot, double pace) = 0;
  // motion::MoveExecutor::hold_behind().
  virtual Result<void> hold_behind(std::string_view robot, std::uint32_t move) = 0;
};

}  // namespace cellmirror::app
