// The chain and the inverse kinematics of one robot of the cell, made when they are first asked for and again when the
// robot has changed. Belongs to the thread that owns the cell.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/cell/robot_chain.hpp"
#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::planning {

class RobotKinematics {
 public:
  // Instead of the robot's own tool centre point (rob_tcp_def); none: that again. From the next update() on.
  void set_tool(const std::optional<Pose>& X_PT);
  // Brings it up to date with the cell. Refused: see robot_chain().
  Result<void> update(const Cell& cell, const RobotModel& robot);

  // From the ZP frame to the TCP. Its variables are all joints of the robot, in their order; those that do not move the
  // tip (of a gripper) are variables without effect. The same object until something of it has changed.
  [[nodiscard]] const std::shared_ptr<const kinematics::Chain>& chain() const { return whole_; }
  [[nodiscard]] Pose X_ZT(const JointValues& joints) const;
  [[nodiscard]] kinematics::Task task(InverseClass inverse_class) const;

  // The method `auto`, within 5 ms of `clock`, which outlives this and is the same in every call; the first call after
  // a change takes some 20 ms more. `present` and the solutions are all joints of the robot.
  [[nodiscard]] Result<inverse_kinematics::Answer> solve(const Pose& X_ZG, const kinematics::Task& task,
                                                         const JointValues& present, const Clock& clock);

 private:
  std::optional<Pose> X_PT_;
  std::uint64_t revision_ = 0;  // of the cell, for which the rest holds; 0: none
  std::optional<RobotChain> moving_;
  std::shared_ptr<const kinematics::Chain> whole_;
  std::unique_ptr<inverse_kinematics::Solver> solver_;
};

}  // namespace cellmirror::planning
