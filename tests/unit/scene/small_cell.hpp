// A cell put together by hand: a table with a camera, a sensor and a workframe on it, and an arm of one joint about z
// that carries a tool.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/display_state.hpp"

namespace cellmirror::scene {

struct SmallCell {
  enum Node : std::int32_t { world, table, camera, sensor, tag, arm, joint, hand, tool, count };

  SmallCell() {
    cell.revision = 1;
    paths = {"", "Table", "Table.CAM", "Table.USS", "Table.Tag", "Arm", "Arm.J_1", "Arm.J_1.Hand", "Tool"};
    cell.paths = std::make_shared<std::vector<std::string>>(paths);
    cell.parent = {-1, world, table, table, table, world, arm, joint, hand};
    cell.naming_parent = {-1, world, table, table, table, world, arm, joint, world};
    cell.X_PF.assign(count, Pose::Identity());
    cell.X_PF[table].translation() << 2, 0, 0.5;
    cell.X_PF[camera].translation() << 0, 0, 1;
    cell.X_PF[tag].translation() << 0.1, 0, 0;
    cell.X_PF[hand].translation() << 1, 0, 0.4;
    cell.X_PF[tool].translation() << 0.2, 0, 0;
    cell.joint_of.assign(count, -1);
    cell.joint_of[joint] = 0;
    cell.joints.resize(1);
    cell.visible.assign(count, 1);
    cell.fixed_count = joint;
    for (std::size_t i = 0; i < cell.fixed_count; ++i) {
      const std::int32_t above = cell.parent[i];
      cell.X_WN_fixed.push_back(above < 0 ? cell.X_PF[i]
                                          : cell.X_WN_fixed[static_cast<std::size_t>(above)] * cell.X_PF[i]);
    }
    cell.cameras.push_back({"CAM", camera, 2.0, 0.5});
    SensorDefinition sonar;
    sonar.range_m = 1.5;
    sonar.half_angle_rad = 0.2;
    cell.sensors.push_back({"USS", sensor, sonar});
    cell.workframes = {tag};
    for (const auto node : {table, arm, hand, tool}) add_box(node);
    add_robot();
    pose(0.0);
  }

  void add_box(std::int32_t node) {
    auto geometry = std::make_shared<Geometry>();
    geometry->shape = Shape::box;
    geometry->size = {0.2, 0.4, 0.6};
    cell.geometry.push_back({node, geometry});
  }

  void add_robot() {
    cell.robot_of_slot.fill(-1);
    cell.robot_of_slot[0] = 0;
    CompiledRobot robot;
    robot.id = "ARM";
    robot.joint_nodes = {joint};
    robot.component = arm;
    robot.base = arm;
    robot.zero_point = arm;
    robot.flange = hand;
    robot.X_FT.translation() << 0, 0, 0.1;
    cell.robots.push_back(robot);
  }

  void pose(double angle_rad) {
    std::vector<JointValues> q(1);
    q[0][0] = angle_rad;
    compute_poses(cell, q, poses);
  }

  [[nodiscard]] std::size_t body_of(Node node) const {
    for (std::size_t i = 0; i < cell.geometry.size(); ++i) {
      if (cell.geometry[i].node == node) return i;
    }
    return cell.geometry.size();
  }

  std::vector<std::string> paths;
  CompiledCell cell;
  CellPoses poses;
  DisplayState display;
};

}  // namespace cellmirror::scene
