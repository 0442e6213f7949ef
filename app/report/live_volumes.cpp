#include "app/report/live_volumes.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "app/snapshot/volume_words.hpp"

namespace cellmirror::app {

namespace {

// A page with more than these would be long; the document stays small.
constexpr std::size_t kMostVolumes = 16;

struct ShownVolume {
  const VolumeState& state;
  const CompiledVolume& placed;
  bool visible;
};

// The states are those of the compiled cell of the same snapshot, in its order.
template <class Function>
void for_volumes(const CellState& cell, const Function& function) {
  if (cell.volumes == nullptr) return;
  const std::size_t count = std::min({kMostVolumes, cell.volumes->size(), cell.cell->volumes.size()});
  for (std::size_t i = 0; i < count; ++i) {
    const CompiledVolume& placed = cell.cell->volumes[i];
    function(
        ShownVolume{(*cell.volumes)[i], placed, cell.cell->visible.at(static_cast<std::size_t>(placed.node)) != 0});
  }
}

void add_planes(JsonWriter& out, const VolumeSettings& settings) {
  out.key("planes").begin_array();
  for (std::size_t i = 0; i < kVolumePlanes; ++i) {
    const VolumePlane& plane = settings.planes.at(i);
    out.begin_object()
        .member("plane", kVolumePlaneWords.at(i))
        .member("side", word(plane.side))
        .member("framed", plane.framed)
        .member("elevation_rad", plane.elevation_rad)
        .member("azimuth_rad", plane.azimuth_rad)
        .member("distance_m", plane.distance_m)
        .end_object();
  }
  out.end_array();
}

void add_parameters(JsonWriter& out, const VolumeSettings& settings) {
  out.key("parameters").begin_object();
  out.key(word(VolumeTable::medical)).begin_array();
  for (const double value :
       {settings.medical.air, settings.medical.fat, settings.medical.tissue, settings.medical.bone})
    out.value(value);
  out.end_array();
  for (std::size_t i = 1; i < kVolumeTables; ++i) {
    const VolumeTableParameters& table = settings.parameters.at(i);
    out.key(kVolumeTableWords.at(i)).begin_array();
    for (const double value : {table.opacity, table.gain, table.level, table.window}) out.value(value);
    out.end_array();
  }
  out.end_object();
}

}  // namespace

void add_volumes(JsonWriter& out, const CellState& cell) {
  out.key("volumes");
  if (cell.volumes == nullptr || cell.volumes->empty()) {
    out.null();
    return;
  }
  out.begin_array();
  for_volumes(cell, [&](const ShownVolume& volume) {
    const VolumeSettings& settings = volume.state.settings;
    out.begin_object()
        .member("name", volume.state.name)
        .member("shown", volume.visible)
        .member("table", word(settings.table));
    add_parameters(out, settings);
    add_planes(out, settings);
    out.member("isosurface", settings.isosurface).member("iso_value", settings.iso_value).end_object();
  });
  out.end_array();
}

void add_volume_contents(JsonWriter& out, const CellState& cell) {
  out.key("volumes").begin_array();
  for_volumes(cell, [&](const ShownVolume& volume) {
    const VoxelGrid& grid = *volume.placed.volume->grid;
    out.begin_object().member("name", volume.state.name).key("voxels").begin_array();
    for (const std::uint32_t voxels : grid.size) out.value(voxels);
    out.end_array().member("half_extent_m", grid.half_extent_m().eval()).member("unit", unit_of(grid)).key("histogram");
    if (volume.state.histogram == nullptr) {
      out.null();
    } else {
      const VolumeHistogram& histogram = *volume.state.histogram;
      out.begin_object().member("low", histogram.low).member("high", histogram.high).key("counts").begin_array();
      for (const std::uint32_t count : histogram.counts) out.value(count);
      out.end_array().end_object();
    }
    out.end_object();
  });
  out.end_array();
}

}  // namespace cellmirror::app
