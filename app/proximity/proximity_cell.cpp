#include "app/proximity/proximity_cell.hpp"

#include "app/subcommands/progress_line.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

std::optional<ProximityCell> load_proximity_cell(const std::string& file, Diagnostics& diagnostics) {
  ProgressLine line("files loaded");
  auto loaded = load_cell(file, diagnostics, [&line](std::size_t done, std::size_t total, std::string_view what) {
    line.tell(done, total, printable(what, 60));
  });
  if (!loaded) return std::nullopt;
  auto compiled = loaded->cell.compile();
  return ProximityCell{std::move(*loaded), std::move(compiled)};
}

}  // namespace cellmirror::app
