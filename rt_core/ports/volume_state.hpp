// What is in force for the voxel volumes of the cell. The owner of the cell publishes it; pictures, reports and the
// page read it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/ports/volume_settings.hpp"
#include "rt_core/ports/volume_user_table.hpp"

namespace cellmirror {

// How often values occur, of at most some millions of voxels evenly spread over the volume.
struct VolumeHistogram {
  static constexpr std::size_t kBins = 128;
  double low = 0;  // in the unit of the volume's values: the lower end of the first bin
  double high = 0;
  std::array<std::uint32_t, kBins> counts{};
};

struct VolumeState {
  std::string name;  // full path of the node that holds the component
  VolumeSettings settings;
  VolumeUserTables user_tables;
  std::uint64_t tables_revision = 0;  // counts VV_RELOAD_LUTS
  std::shared_ptr<const VolumeHistogram> histogram;
};

using VolumeStates = std::vector<VolumeState>;  // in the order of CompiledCell::volumes

}  // namespace cellmirror
