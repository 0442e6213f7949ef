#include "rt_core/scene/robot_parts.hpp"

namespace cellmirror::scene {

void RobotParts::update(const CompiledCell& cell) {
  std::vector<std::int16_t> of_component(cell.size(), -1);
  for (const CompiledRobot& robot : cell.robots)
    of_component[static_cast<std::size_t>(robot.component)] = static_cast<std::int16_t>(robot.slot);
  decide_.assign(cell.size(), {});
  part_of_.assign(cell.size(), -1);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    // In the tree of names: a tool that was put into a hand is part of the toolbox still.
    for (auto up = static_cast<std::int32_t>(i); up >= 0 && part_of_[i] < 0;
         up = cell.naming_parent[static_cast<std::size_t>(up)])
      part_of_[i] = of_component[static_cast<std::size_t>(up)];
    if (part_of_[i] >= 0) decide_[i].set(static_cast<std::size_t>(part_of_[i]));
    if (cell.joint_of[i] >= 0) decide_[i].set(cell.joints[static_cast<std::size_t>(cell.joint_of[i])].slot);
    // Kinematic parents stand before their children.
    if (cell.parent[i] >= 0) decide_[i] |= decide_[static_cast<std::size_t>(cell.parent[i])];
  }
}

}  // namespace cellmirror::scene
