#include "app/snapshot/robot_states.hpp"

namespace cellmirror::app {

namespace {

void fill(RobotState& out, const CompiledRobot& robot, const engine::RobotTickState& state,
          const engine::TickState& tick) {
  out.id = robot.id;
  out.online = state.mode == engine::RobotMode::mirrored;
  out.sequence = out.online ? state.sequence : tick.tick;
  out.state = state.state;
  out.joints.resize(robot.joint_names.size());
  for (std::size_t i = 0; i < out.joints.size(); ++i) {
    RobotJointState& joint = out.joints[i];
    const engine::JointTickState& from = state.joints[i];
    joint.name = robot.joint_names[i];
    joint.kind = robot.joint_kinds[i];
    joint.position = from.position;
    joint.velocity = from.velocity;
    joint.effort = from.effort;
    joint.state = from.state;
    joint.source_time = from.source_time;
    joint.receive_time = from.receive_time;
    joint.implausible = from.state == DataState::implausible ? from.implausible : Implausibility::none;
  }
}

}  // namespace

std::span<const RobotState> RobotStateBuilder::build(const CellState& cell_state, const engine::TickState& state) {
  const CompiledCell& cell = *cell_state.cell;
  poser_.take_known(cell, state);
  robots_.resize(cell.robots.size());
  for (std::size_t i = 0; i < cell.robots.size(); ++i) {
    const CompiledRobot& robot = cell.robots[i];
    fill(robots_[i], robot, state.robots[robot.slot], state);
    const TcpPoses tcp = tcp_poses(robot, poses());
    robots_[i].X_BT = tcp.X_BT;
    robots_[i].X_WT = tcp.X_WT;
  }
  return robots_;
}

std::span<const FramePose> RobotStateBuilder::frames(const CellState& cell_state, const std::vector<bool>& wanted) {
  const CompiledCell& cell = *cell_state.cell;
  frames_.clear();
  for (std::size_t i = 0; i < cell.robots.size(); ++i) {
    if (!wanted[i]) continue;
    const CompiledRobot& robot = cell.robots[i];
    std::string parent = "world";
    Pose X_WP = Pose::Identity();
    const auto link = [&](const std::string& child, const Pose& X_WC) {
      frames_.push_back({parent, child, X_WP.inverse(Eigen::Isometry) * X_WC});
      parent = child;
      X_WP = X_WC;
    };
    const auto X_WN = [&](std::int32_t node) -> const Pose& { return poses().X_WN[static_cast<std::size_t>(node)]; };
    link(robot.id + "/base", X_WN(robot.base));
    for (std::size_t j = 0; j < robot.joint_nodes.size(); ++j) {
      link(robot.id + "/" + robot.joint_names[j], X_WN(robot.joint_nodes[j]));
    }
    link(robot.id + "/flange", X_WN(robot.flange));
    link(robot.id + "/tcp", robots_[i].X_WT);
  }
  return frames_;
}

}  // namespace cellmirror::app
