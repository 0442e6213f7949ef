// A cell file and its postures, loaded for `collide` and `range`. Both show their progress on a terminal, and print all
// diagnostics on standard error.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/proximity/postures.hpp"
#include "config/cell_file.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

struct ProximityCell {
  LoadedCell loaded;
  std::shared_ptr<const CompiledCell> compiled;
};

// As the cell file describes it: the startup script is not run. Nothing where a file is wrong.
[[nodiscard]] std::optional<ProximityCell> load_proximity_cell(const std::string& file);
// See Postures::open(). Null where the file is wrong.
[[nodiscard]] std::unique_ptr<Postures> open_postures(const std::string& file, const ProximityCell& cell);

}  // namespace cellmirror::app
