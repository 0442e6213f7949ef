// A cell file, loaded for `collide` and `range`.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "config/cell_file.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

struct ProximityCell {
  LoadedCell loaded;
  std::shared_ptr<const CompiledCell> compiled;
};

// As the cell file describes it: the startup script is not run. Tells its progress on a terminal. Nothing, and all
// findings, where a file is wrong.
[[nodiscard]] std::optional<ProximityCell> load_proximity_cell(const std::string& file, Diagnostics& diagnostics);

}  // namespace cellmirror::app
