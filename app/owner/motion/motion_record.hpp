// What the motion service knows of one robot: the moves on their way and where they lead. Belongs to the thread that
// owns the cell.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/owner/motion/pending_moves.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/planning/robot_kinematics.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "scripts/commands/motion_host.hpp"

namespace cellmirror::app {

// Where a robot was last commanded to.
struct MotionGoal {
  JointValues joints{};      // rad or m
  std::optional<Pose> X_ZT;  // as it was commanded, where the task is the whole pose
  std::shared_ptr<const kinematics::Chain> chain;
};

struct PlannedMove {
  motion::Move move;
  MotionGoal goal;
};

struct MotionRecord {
  explicit MotionRecord(const std::string& id) : pending(id) {}
  PendingMoves pending;
  planning::RobotKinematics kinematics;
  std::optional<MotionGoal> goal;  // none: where the robot stands
  Positioning positioning = Positioning::moving;
  std::shared_ptr<const kinematics::Chain> chain_of_tick;
};

// The commanded pose as MotionGoal::X_ZT: the next increment starts from it, so that a stream of them does not gather
// the tolerance of the inverse kinematics. Nothing where the task leaves something open.
[[nodiscard]] std::optional<Pose> commanded_pose(const kinematics::Task& task, const Pose& X_ZG);

}  // namespace cellmirror::app
