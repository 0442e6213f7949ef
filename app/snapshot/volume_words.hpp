// Words of the settings of voxel volumes, for documents.
#pragma once

#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>

#include "rt_core/ports/volume_settings.hpp"
#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror::app {

// What a plane hides, as VV_CLIP has it.
[[nodiscard]] constexpr std::string_view word(VolumePlaneSide side) {
  switch (side) {
    case VolumePlaneSide::none:
      return "off";
    case VolumePlaneSide::beyond:
      return "active";
    case VolumePlaneSide::before:
      return "reverse";
  }
  return "off";
}

[[nodiscard]] constexpr std::string_view word(VolumeTable table) {
  return kVolumeTableWords.at(static_cast<std::size_t>(std::to_underlying(table)));
}

// "HU" or "": of the volume's values.
[[nodiscard]] inline std::string_view unit_of(const VoxelGrid& grid) { return grid.hounsfield ? "HU" : ""; }

[[nodiscard]] inline std::size_t bytes_of(const VoxelGrid& grid) {
  return std::visit([](const auto& values) { return values.size() * sizeof(values.front()); }, grid.values);
}

}  // namespace cellmirror::app
