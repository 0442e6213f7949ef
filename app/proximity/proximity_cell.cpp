#include "app/proximity/proximity_cell.hpp"

#include <cstdio>
#include <utility>

#include "app/console/load_progress.hpp"

namespace cellmirror::app {

std::optional<ProximityCell> load_proximity_cell(const std::string& file) {
  Diagnostics diagnostics;
  std::optional<LoadedCell> loaded;
  {
    ProgressLine line("files loaded");
    loaded = load_cell(file, diagnostics, load_progress(line));
  }
  std::fputs(diagnostics.text(Severity::warning).c_str(), stderr);
  if (!loaded) return std::nullopt;
  auto compiled = loaded->cell.compile();
  return ProximityCell{std::move(*loaded), std::move(compiled)};
}

std::unique_ptr<Postures> open_postures(const std::string& file, const ProximityCell& cell) {
  Diagnostics diagnostics;
  std::unique_ptr<Postures> postures;
  {
    ProgressLine line("bytes of postures checked");
    postures = Postures::open(file, cell.loaded.cell, diagnostics,
                              [&line](std::uint64_t done, std::uint64_t total) { line.update(done, total); });
  }
  std::fputs(diagnostics.text().c_str(), stderr);
  return postures;
}

}  // namespace cellmirror::app
