// How each part of the cell is to be drawn (SET_FRAME RENDER, SET_ABSTRACT RENDER).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/display_state.hpp"

namespace cellmirror::scene {

// `rule` speaks of the node with this full path.
[[nodiscard]] bool covers(const DrawRule& rule, std::string_view path);

// By index into cell.geometry. Of the rules that cover the node of a geometry the last one counts; none: gouraud. A
// coarse geometry belongs to its own node, not to the parts it represents. A path that is not in the cell (not loaded,
// deleted) has no effect until it is.
[[nodiscard]] std::vector<DrawMode> draw_modes(const CompiledCell& cell, std::span<const DrawRule> rules);

}  // namespace cellmirror::scene
