#include "rt_core/scene/paths.hpp"

#include <cstddef>

namespace cellmirror::scene {

std::string_view path_of(const CompiledCell& cell, std::int32_t node) {
  const auto index = static_cast<std::size_t>(node);
  if (node < 0 || cell.paths == nullptr || index >= cell.paths->size()) return {};
  return (*cell.paths)[index];
}

std::string_view last_name(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

bool names_node(const CompiledCell& cell, std::string_view name, std::int32_t node) {
  const std::string_view path = path_of(cell, node);
  if (name.empty() || !path.ends_with(name)) return false;
  return path.size() == name.size() || path[path.size() - name.size() - 1] == '.';
}

std::optional<std::int32_t> node_at(const CompiledCell& cell, std::string_view path) {
  std::optional<std::int32_t> ending;
  for (std::int32_t node = 0; static_cast<std::size_t>(node) < cell.size(); ++node) {
    const std::string_view here = path_of(cell, node);
    if (here.size() < path.size()) continue;
    if (here == path) return node;
    if (!ending && names_node(cell, path, node)) ending = node;
  }
  return ending;
}

}  // namespace cellmirror::scene
