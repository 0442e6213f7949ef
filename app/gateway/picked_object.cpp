#include "app/gateway/picked_object.hpp"

#include <algorithm>

namespace cellmirror::app {

std::optional<PickedObject> picked_object(const CompiledCell& cell, std::uint32_t object) {
  if (object == 0 || object > cell.size()) return std::nullopt;
  const auto node = static_cast<std::int32_t>(object - 1);
  PickedObject out;
  out.path = (*cell.paths)[static_cast<std::size_t>(node)];
  // The nearest component above it that is a robot's.
  for (std::int32_t at = node; at >= 0; at = cell.naming_parent[static_cast<std::size_t>(at)]) {
    const auto robot = std::ranges::find(cell.robots, at, &CompiledRobot::component);
    if (robot == cell.robots.end()) continue;
    out.robot = robot->id;
    break;
  }
  return out;
}

}  // namespace cellmirror::app
