// Which robots decide where a node is, and whose part it is.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::scene {

using RobotSet = std::bitset<kMaxRobots>;  // by slot

class RobotParts {
 public:
  void update(const CompiledCell& cell);
  // Robots whose joints move the node, or whose model it is part of.
  [[nodiscard]] RobotSet decide(std::int32_t node) const { return decide_[static_cast<std::size_t>(node)]; }
  // Slot of the robot whose model it is part of; -1: of none.
  [[nodiscard]] int part_of(std::int32_t node) const { return part_of_[static_cast<std::size_t>(node)]; }

 private:
  std::vector<RobotSet> decide_;
  std::vector<std::int16_t> part_of_;
};

}  // namespace cellmirror::scene
