// Takes the motion commands of SCRIPT, makes moves of them and gives them to the tick; knows where every robot was last
// commanded to. Belongs to the thread that owns the cell. docs/script.md, "Motion", says what the commands mean.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "app/gateway/coupled_robots.hpp"
#include "app/gateway/motion_port.hpp"
#include "app/gateway/pending_moves.hpp"
#include "app/gateway/robot_kinematics.hpp"
#include "rt_core/cell/cell.hpp"
#include "scripts/commands/motion_host.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::app {

class MotionDesk final : public MotionHost {
 public:
  // `screen_axes`: R_WS of the current view as it is now, for SCREEN_INC.
  MotionDesk(const Cell& cell, const NameDirectory& names, std::function<Eigen::Matrix3d()> screen_axes,
             MotionPort& port)
      : cell_(cell), names_(names), screen_axes_(std::move(screen_axes)), port_(port) {}

  // Null, as in the beginning: no robot follows another. They outlive the desk.
  void set_coupled(const CoupledRobots* coupled) { coupled_ = coupled; }

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
  void give_up(std::string_view robot, const Error& why);
  // give_up() for robots that the cell does not have any more. After every change of the tree.
  void follow_cell();

  // Rad or m: where the newest commanded move ends. Nothing for a robot that was not commanded since it was loaded or
  // stopped.
  [[nodiscard]] std::optional<JointValues> target(std::string_view robot) const;
  [[nodiscard]] Positioning positioning(std::string_view robot) const;

 private:
  // Where a robot was last commanded to.
  struct Goal {
    JointValues joints{};
    std::optional<Pose> X_ZT;  // as it was commanded, where the task is the whole pose
    std::shared_ptr<const kinematics::Chain> chain;
  };
  struct Record {
    explicit Record(const std::string& id) : pending(id) {}
    PendingMoves pending;
    RobotKinematics kinematics;
    std::optional<Goal> goal;  // none: where the robot stands
    Positioning positioning = Positioning::moving;
    std::shared_ptr<const kinematics::Chain> chain_of_tick;
  };
  struct Planned {
    motion::Move move;
    Goal goal;
  };

  // Refused: unknown, online.
  Result<Record*> open(const RobotModel* robot, std::string_view id);
  void follow(const RobotModel& robot, Record& record);
  [[nodiscard]] Goal goal_of(const RobotModel& robot, const Record& record);
  // The chain of `record` must be up to date.
  Result<JointValues> joint_target(const RobotModel& robot, const MotionTarget& target, const Goal& from) const;
  Result<Pose> pose_target(const RobotModel& robot, Record& record, const MotionTarget& target, const Goal& from);
  Result<Goal> point(const RobotModel& robot, Record& record, const MotionTarget& target, const Goal& from);
  Result<Planned> plan(const RobotModel& robot, Record& record, MovePath path, const MotionTarget& target,
                       motion::Start start);
  Result<void> send(const RobotModel& robot, Record& record, Planned planned, motion::Start start);
  Result<void> jump(const RobotModel& robot, Record& record, const MotionTarget& target);
  // Coupled joints stay with their master: refused where the goal has them elsewhere, or a path would move them.
  [[nodiscard]] Result<void> check_coupled(const RobotModel& robot, const JointValues& from, JointValues& goal) const;
  [[nodiscard]] Result<void> check_uncoupled(const RobotModel& robot) const;
  [[nodiscard]] Result<void> check_limits(const RobotModel& robot, const JointValues& joints) const;

  const Cell& cell_;
  const NameDirectory& names_;
  std::function<Eigen::Matrix3d()> screen_axes_;
  MotionPort& port_;
  const CoupledRobots* coupled_ = nullptr;
  std::map<std::string, Record, std::less<>> records_;
};

}  // namespace cellmirror::app
