#include "rt_core/scene/draw_rules.hpp"

#include <ranges>

#include "rt_core/scene/paths.hpp"

namespace cellmirror::scene {

bool covers(const DrawRule& rule, std::string_view path) {
  if (!path.starts_with(rule.path)) return false;
  if (path.size() == rule.path.size()) return true;
  if (!rule.branch) return false;
  return rule.path.empty() || path[rule.path.size()] == '.';  // the world has the empty path
}

std::vector<DrawMode> draw_modes(const CompiledCell& cell, std::span<const DrawRule> rules) {
  std::vector<DrawMode> modes(cell.geometry.size(), DrawMode::gouraud);
  if (rules.empty()) return modes;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    // Geometry of a node is contiguous.
    if (i > 0 && cell.geometry[i].node == cell.geometry[i - 1].node) {
      modes[i] = modes[i - 1];
      continue;
    }
    const std::string_view path = path_of(cell, cell.geometry[i].node);
    for (const DrawRule& rule : rules | std::views::reverse) {
      if (!covers(rule, path)) continue;
      modes[i] = rule.mode;
      break;
    }
  }
  return modes;
}

}  // namespace cellmirror::scene
