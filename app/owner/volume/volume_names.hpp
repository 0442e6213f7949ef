// The voxel volumes of a cell as SCRIPT names them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/cell.hpp"

namespace cellmirror::app {

// Full paths of the nodes with a volume in memory, shown or not.
[[nodiscard]] std::vector<std::string> volume_names(const Cell& cell);

// The full path of the volume that `name` means: shorter paths as everywhere. Refused: none, with the nearest names, or
// the cell has no volume at all.
[[nodiscard]] Result<std::string> find_volume(const Cell& cell, std::string_view name);

// Why a command for volumes is refused in a cell without any.
[[nodiscard]] Error no_volumes();

}  // namespace cellmirror::app
