#include "app/proximity/proximity_cell.hpp"

#include "app/subcommands/load_progress.hpp"

namespace cellmirror::app {

std::optional<ProximityCell> load_proximity_cell(const std::string& file, Diagnostics& diagnostics) {
  ProgressLine line("files loaded");
  auto loaded = load_cell(file, diagnostics, load_progress(line));
  if (!loaded) return std::nullopt;
  auto compiled = loaded->cell.compile();
  return ProximityCell{std::move(*loaded), std::move(compiled)};
}

}  // namespace cellmirror::app
