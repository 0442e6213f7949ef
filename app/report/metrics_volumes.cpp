#include "app/report/metrics_volumes.hpp"

#include <algorithm>
#include <cstddef>

#include "app/snapshot/volume_words.hpp"

namespace cellmirror::app {

void add_volume_metrics(MetricsText& out, const LiveSources& sources) {
  const CellState& cell = sources.cell_state;
  if (cell.volumes == nullptr || cell.volumes->empty()) return;
  const std::size_t count = std::min(cell.volumes->size(), cell.cell->volumes.size());
  const auto for_volumes = [&](std::string_view name, std::string_view help, auto value) {
    out.family(name, "gauge", help);
    for (std::size_t i = 0; i < count; ++i)
      out.sample(value(cell.cell->volumes[i]), {{"volume", (*cell.volumes)[i].name}});
  };
  for_volumes("cellmirror_volume_voxels", "Voxels of a volume.",
              [](const CompiledVolume& placed) { return static_cast<double>(placed.volume->grid->count()); });
  for_volumes("cellmirror_volume_bytes", "Memory of the values of a volume.",
              [](const CompiledVolume& placed) { return static_cast<double>(bytes_of(*placed.volume->grid)); });
  for_volumes("cellmirror_volume_shown", "1: the volume is drawn; 0: its component is hidden.",
              [&](const CompiledVolume& placed) {
                return cell.cell->visible.at(static_cast<std::size_t>(placed.node)) != 0 ? 1.0 : 0.0;
              });
  const RendererCounters& drawn = sources.renderer;
  out.one("cellmirror_volume_picture_seconds", "gauge",
          "Time for casting all volumes of the newest picture for which any was cast.",
          static_cast<double>(drawn.volume_ns) * 1e-9);
  out.one("cellmirror_volume_bricks", "gauge", "Bricks of the volumes of the newest picture.",
          static_cast<double>(drawn.volume_bricks));
  out.one("cellmirror_volume_bricks_drawn", "gauge", "Of these, bricks in which something is to be seen.",
          static_cast<double>(drawn.volume_bricks_drawn));
  out.one("cellmirror_volume_reduction", "gauge",
          "Edge of the square of pixels for which one ray stands; 1: full resolution, 0: no volume was drawn.",
          static_cast<double>(drawn.volume_reduction));
}

}  // namespace cellmirror::app
