// What the motion service knows of one robot: the moves on their way and where they lead. Belongs to the thread that
// owns the cell.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/owner/motion/pending_moves.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/planning/move_planner.hpp"
#include "rt_core/planning/robot_kinematics.hpp"
#include "scripts/commands/motion_host.hpp"

namespace cellmirror::app {

struct MotionRecord {
  explicit MotionRecord(const std::string& id) : pending(id) {}
  PendingMoves pending;
  planning::RobotKinematics kinematics;
  std::optional<planning::MotionGoal> goal;  // none: where the robot stands
  Positioning positioning = Positioning::moving;
  std::shared_ptr<const kinematics::Chain> chain_of_tick;
};

}  // namespace cellmirror::app
