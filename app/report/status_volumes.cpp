#include "app/report/status_volumes.hpp"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "app/report/status_values.hpp"
#include "app/snapshot/volume_words.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

json planes_json(const VolumeSettings& settings) {
  json out = json::array();
  for (std::size_t i = 0; i < kVolumePlanes; ++i) {
    const VolumePlane& plane = settings.planes.at(i);
    out.push_back({{"plane", kVolumePlaneWords.at(i)},
                   {"side", word(plane.side)},
                   {"framed", plane.framed},
                   {"elevation_rad", plane.elevation_rad},
                   {"azimuth_rad", plane.azimuth_rad},
                   {"distance_m", plane.distance_m}});
  }
  return out;
}

json parameters_json(const VolumeSettings& settings) {
  const MedicalTableParameters& medical = settings.medical;
  json out = json::object();
  out[std::string(word(VolumeTable::medical))] = {
      {"air", medical.air}, {"fat", medical.fat}, {"tissue", medical.tissue}, {"bone", medical.bone}};
  for (std::size_t i = 1; i < kVolumeTables; ++i) {
    const VolumeTableParameters& table = settings.parameters.at(i);
    out[std::string(kVolumeTableWords.at(i))] = {
        {"opacity", table.opacity}, {"gain", table.gain}, {"level", table.level}, {"window", table.window}};
  }
  return out;
}

json user_tables_json(const VolumeState& state) {
  json out = json::array();
  for (std::size_t i = 0; i < kVolumeUserTables; ++i) {
    if (state.user_tables.at(i) != nullptr) out.push_back(kVolumeTableWords.at(kVolumeTables - kVolumeUserTables + i));
  }
  return out;
}

}  // namespace

json volumes_json(const CellState& cell) {
  json out = json::array();
  if (cell.volumes == nullptr) return out;
  for (std::size_t i = 0; i < std::min(cell.volumes->size(), cell.cell->volumes.size()); ++i) {
    const VolumeState& state = (*cell.volumes)[i];
    const CompiledVolume& placed = cell.cell->volumes[i];
    const VoxelGrid& grid = *placed.volume->grid;
    out.push_back({{"name", state.name},
                   {"shown", cell.cell->visible.at(static_cast<std::size_t>(placed.node)) != 0},
                   {"voxels", grid.size},
                   {"spacing_m", vector_json(grid.spacing_m)},
                   {"bytes", bytes_of(grid)},
                   {"hounsfield", grid.hounsfield},
                   {"values", state.histogram ? json{state.histogram->low, state.histogram->high} : json(nullptr)},
                   {"table", word(state.settings.table)},
                   {"parameters", parameters_json(state.settings)},
                   {"user_tables", user_tables_json(state)},
                   {"tables_revision", state.tables_revision},
                   {"planes", planes_json(state.settings)},
                   {"isosurface", state.settings.isosurface},
                   {"iso_value", state.settings.iso_value}});
  }
  return out;
}

}  // namespace cellmirror::app
