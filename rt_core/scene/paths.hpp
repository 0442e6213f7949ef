// Nodes of a compiled cell by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::scene {

// Full dotted path of a node; empty where the cell has none.
[[nodiscard]] std::string_view path_of(const CompiledCell& cell, std::int32_t node);
// The last part of a path.
[[nodiscard]] std::string_view last_name(std::string_view path);
// `name` is the node's path or ends it at a dot.
[[nodiscard]] bool names_node(const CompiledCell& cell, std::string_view name, std::int32_t node);
// The node with this full path; where there is none, the first whose path it ends.
[[nodiscard]] std::optional<std::int32_t> node_at(const CompiledCell& cell, std::string_view path);

}  // namespace cellmirror::scene
