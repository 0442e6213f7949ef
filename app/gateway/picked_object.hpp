// What a pixel of the picture belongs to.
#pragma once

#include <cstdint>
#include <optional>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/picture_request.hpp"

namespace cellmirror::app {

// `object`: as in SceneBody. None for 0, and for what the cell does not have any more.
[[nodiscard]] std::optional<PickedObject> picked_object(const CompiledCell& cell, std::uint32_t object);

}  // namespace cellmirror::app
