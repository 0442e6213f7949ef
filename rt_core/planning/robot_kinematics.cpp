#include "rt_core/planning/robot_kinematics.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::planning {

namespace {

bool same(const kinematics::ChainJoint& a, const kinematics::ChainJoint& b) {
  return a.X_PJ.matrix() == b.X_PJ.matrix() && a.kind == b.kind && a.variable == b.variable &&
         a.multiplier == b.multiplier && a.offset == b.offset;
}

bool same(const kinematics::Chain& a, const kinematics::Chain& b) {
  return a.X_LT().matrix() == b.X_LT().matrix() && std::ranges::equal(a.lower(), b.lower()) &&
         std::ranges::equal(a.upper(), b.upper()) &&
         std::ranges::equal(a.joints(), b.joints(), [](const auto& x, const auto& y) { return same(x, y); });
}

// The chain with all joints of the robot as variables, so that tick and planner need no translation.
Result<kinematics::Chain> with_all_joints(const RobotChain& moving, const RobotModel& robot) {
  if (moving.chain.variable_count() == robot.joint_count()) return moving.chain;
  std::vector<kinematics::Variable> variables;
  for (std::size_t i = 0; i < robot.joint_count(); ++i) {
    const RobotJoint& joint = robot.joints()[i];
    variables.push_back({joint.name, joint.kind, robot.parameters().min_range[i], robot.parameters().max_range[i]});
  }
  std::vector<kinematics::ChainJoint> joints(moving.chain.joints().begin(), moving.chain.joints().end());
  for (kinematics::ChainJoint& joint : joints) joint.variable = moving.joint[joint.variable];
  for (std::size_t i = 0; i < robot.joint_count(); ++i) {
    if (std::ranges::find(moving.joint, i) != moving.joint.end()) {
      const auto variable = static_cast<std::size_t>(std::ranges::find(moving.joint, i) - moving.joint.begin());
      variables[i] = moving.chain.variables()[variable];
      continue;
    }
    kinematics::ChainJoint without_effect;
    without_effect.kind = robot.joints()[i].kind;
    without_effect.variable = static_cast<std::uint8_t>(i);
    without_effect.multiplier = 0.0;
    joints.insert(joints.begin(), without_effect);
  }
  return kinematics::Chain::make(std::move(variables), joints, moving.chain.X_LT());
}

}  // namespace

void RobotKinematics::set_tool(const std::optional<Pose>& X_PT) {
  if (X_PT_.has_value() == X_PT.has_value() && (!X_PT || X_PT->matrix() == X_PT_->matrix())) return;
  X_PT_ = X_PT;
  revision_ = 0;
}

Result<void> RobotKinematics::update(const Cell& cell, const RobotModel& robot) {
  if (revision_ == cell.revision()) return {};
  auto moving = robot_chain(cell, robot.id());
  if (!moving) return std::unexpected(moving.error());
  if (X_PT_) {
    const Pose X_LP = moving->chain.X_LT() * robot.parameters().X_PT.inverse();
    moving->chain = moving->chain.with_tip(X_LP * *X_PT_);
  }
  auto whole = with_all_joints(*moving, robot);
  if (!whole) return std::unexpected(whole.error());
  revision_ = cell.revision();
  if (whole_ && same(*whole_, *whole)) return {};
  moving_ = std::move(*moving);
  whole_ = std::make_shared<const kinematics::Chain>(std::move(*whole));
  solver_.reset();
  return {};
}

Pose RobotKinematics::X_ZT(const JointValues& joints) const {
  return kinematics::forward(*whole_, std::span(joints).first(whole_->variable_count()));
}

kinematics::Task RobotKinematics::task(InverseClass inverse_class) const {
  return kinematics::task_of(inverse_class, moving_->chain);
}

Result<inverse_kinematics::Answer> RobotKinematics::solve(const Pose& X_ZG, const kinematics::Task& task,
                                                          const JointValues& present, const Clock& clock) {
  if (!solver_) solver_ = inverse_kinematics::make_solver(inverse_kinematics::Method::automatic, moving_->chain, clock);
  inverse_kinematics::Request request;
  request.X_BG = X_ZG;
  request.task = task;
  request.present = moving_->variables_of(present);
  auto answer = solver_->solve(request);
  if (!answer) return answer;
  for (inverse_kinematics::Solution& solution : answer->solutions) solution.q = moving_->joints_of(solution.q, present);
  return answer;
}

}  // namespace cellmirror::planning
