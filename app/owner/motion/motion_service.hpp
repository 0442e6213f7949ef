// Takes the motion commands of SCRIPT, makes moves of them and gives them to the tick; knows where every robot was last
// commanded to. Belongs to the thread that owns the cell. docs/script.md, "Motion", says what the commands mean.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "app/owner/motion/coupled_robots.hpp"
#include "app/owner/motion/motion_port.hpp"
#include "app/owner/motion/motion_record.hpp"
#include "rt_core/cell/cell.hpp"
#include "scripts/commands/motion_host.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::app {

class MotionService final : public MotionHost {
 public:
  using Coupled = std::function<const CoupledRobots&()>;
  // `screen_axes`: R_WS of the current view as it is now, for SCREEN_INC. `coupled`: asked at each command, since
  // couplings are made by a service that moves robots with this one; empty: no robot follows another.
  MotionService(const Cell& cell, const NameDirectory& names, std::function<Eigen::Matrix3d()> screen_axes,
                MotionPort& port, const Clock& clock, Coupled coupled = {})
      : cell_(cell),
        names_(names),
        screen_axes_(std::move(screen_axes)),
        port_(port),
        clock_(clock),
        coupled_(std::move(coupled)) {}

  Result<ActivityHandle> position(std::string_view robot, const MotionTarget& target) override;
  Result<void> queue_move(std::string_view robot, MovePath path, const MotionTarget& target) override;
  Result<void> stop(std::string_view robot) override;
  Result<void> set_positioning(Positioning positioning) override;
  // As far as follow() has seen.
  [[nodiscard]] bool moving() const override;

  // Looks at what the tick has done, and ends the activities whose moves have ended. Often.
  void follow();
  // The robot has stopped to take motion commands, or stands elsewhere than it was commanded to: waiting activities are
  // refused with `why`. Unknown robots and those that were never commanded are passed over.
  void cancel(std::string_view robot, const Error& why);
  // cancel() for robots that the cell does not have any more. After every change of the tree.
  void follow_cell();

  // Rad or m: where the newest commanded move ends. Nothing for a robot that was not commanded since it was loaded or
  // stopped.
  [[nodiscard]] std::optional<JointValues> target(std::string_view robot) const;
  [[nodiscard]] Positioning positioning(std::string_view robot) const;

  // For the moves of programs, which are planned elsewhere (program_motion.hpp).
  // What is known of a robot, as far as the tick has shown. Refused: unknown, online.
  Result<MotionRecord*> open(const RobotModel* robot, std::string_view id);
  // Where the newest move ends, or the robot stands, for plans with `chain`.
  [[nodiscard]] planning::MotionGoal goal_of(const RobotModel& robot, const MotionRecord& record,
                                             const std::shared_ptr<const kinematics::Chain>& chain);
  // Gives the move to the tick, with the next id. `goal.chain` null (a delay): the goal stays.
  Result<void> send(const RobotModel& robot, MotionRecord& record, planning::PlannedMove planned, motion::Start start);
  // Refused: joints of it follow a master.
  [[nodiscard]] Result<void> check_free(const RobotModel& robot) const;

 private:
  void follow(const RobotModel& robot, MotionRecord& record);
  // The chain of `record` must be up to date.
  Result<Pose> pose_target(const RobotModel& robot, MotionRecord& record, const MotionTarget& target,
                           const planning::MotionGoal& from);
  Result<planning::MotionGoal> point(const RobotModel& robot, MotionRecord& record, const MotionTarget& target,
                                     const planning::MotionGoal& from);
  Result<planning::PlannedMove> plan(const RobotModel& robot, MotionRecord& record, MovePath path,
                                     const MotionTarget& target, motion::Start start);
  Result<void> jump(const RobotModel& robot, MotionRecord& record, const MotionTarget& target);
  // Coupled joints stay with their master: refused where the goal has them elsewhere, or a path would move them.
  [[nodiscard]] Result<void> check_coupled(const RobotModel& robot, const JointValues& from, JointValues& goal) const;
  [[nodiscard]] Result<void> check_uncoupled(const RobotModel& robot) const;
  // The joints (bits) of the robot that follow a master.
  [[nodiscard]] unsigned coupled_joints(std::string_view robot) const;
  [[nodiscard]] Result<void> check_limits(const RobotModel& robot, const JointValues& joints) const;

  const Cell& cell_;
  const NameDirectory& names_;
  std::function<Eigen::Matrix3d()> screen_axes_;
  MotionPort& port_;
  const Clock& clock_;  // for the time limits of inverse kinematics
  Coupled coupled_;
  std::map<std::string, MotionRecord, std::less<>> records_;
};

}  // namespace cellmirror::app
