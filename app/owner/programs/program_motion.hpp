// The moves of robot programs: canonical commands become moves behind those before, planned from where the newest one
// ends, and go to the tick by way of the motion service, which knows all moves of a robot. Belongs to the thread that
// owns the cell.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/owner/motion/motion_port.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/planning/robot_kinematics.hpp"
#include "scripts/programs/controller/program_motion.hpp"

namespace cellmirror::app {

// The tickets are the ids of the moves in the tick (motion::MotionState). All three outlive it.
class CellProgramMotion final : public program::ProgramMotion {
 public:
  CellProgramMotion(const Cell& cell, MotionService& motion, MotionPort& port, const Clock& clock)
      : cell_(cell), motion_(motion), port_(port), clock_(clock) {}

  Result<void> check(std::string_view robot) const override;
  [[nodiscard]] bool room(std::string_view robot) const override;
  Result<std::uint32_t> move(std::string_view robot, const program::MoveCommand& command, Timestamp begin) override;
  Result<std::uint32_t> delay(std::string_view robot, double seconds, Timestamp begin) override;
  // For the moves of programs and position() only: rob_tcp_def, and what SCRIPT reports, stay. Refused
  // for robots that are gone, whose tool is forgotten.
  Result<void> set_tool(std::string_view robot, const std::optional<Pose>& X_PT) override;
  [[nodiscard]] program::MotionProgress progress(std::string_view robot) const override;
  Result<void> set_pace(std::string_view robot, double pace) override;
  Result<void> hold_behind(std::string_view robot, std::uint32_t ticket) override;
  // Ends both kinds of hold as well.
  Result<void> stop(std::string_view robot) override;

  // Unknown robots have none.
  [[nodiscard]] std::span<const JointKind> joint_kinds(std::string_view robot) const override;
  [[nodiscard]] JointValues joints(std::string_view robot) const override;
  [[nodiscard]] Result<Pose> position(std::string_view robot) const override;
  [[nodiscard]] double program_delay(std::string_view robot) const override;

 private:
  // Of one robot, with the tool of its program.
  struct Arm {
    planning::RobotKinematics kinematics;
    std::vector<JointKind> joint_kinds;
  };
  // Where a move begins, and what it is planned with.
  struct Scene {
    const RobotModel& robot;
    Arm& arm;
    planning::MotionGoal from;
    Pose X_ZS;  // of `from`
    RobotParameters parameters;
  };

  // Refused: unknown.
  Result<Arm*> arm(std::string_view robot) const;
  [[nodiscard]] Result<Pose> pose_of(const Scene& scene, const program::Target& target) const;
  Result<planning::PlannedMove> plan(const Scene& scene, const program::MoveCommand& command) const;
  Result<planning::PlannedMove> plan_joints(const Scene& scene, const program::MoveCommand& command) const;
  Result<planning::PlannedMove> plan_path(const Scene& scene, const program::MoveCommand& command) const;

  const Cell& cell_;
  MotionService& motion_;
  MotionPort& port_;
  const Clock& clock_;
  mutable std::map<std::string, Arm, std::less<>> arms_;
};

}  // namespace cellmirror::app
