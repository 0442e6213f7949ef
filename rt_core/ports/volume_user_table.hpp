// The rows of a look-up table of the user's (USER1_LUT, USER2_LUT), which rt_core/volume/user_table.hpp reads from a
// file of the cell's home. Plain data.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace cellmirror {

struct VolumeUserRow {
  double value = 0;            // in the unit of VoxelGrid::value()
  std::array<float, 3> rgb{};  // 0 to 1, sRGB
  float opacity = 0;           // 0 to 1
  bool operator==(const VolumeUserRow&) const = default;
};

struct VolumeUserTable {
  std::vector<VolumeUserRow> rows;  // at least 2, by strictly rising value
  bool operator==(const VolumeUserTable&) const = default;
};

// USER1_LUT and USER2_LUT; null: the cell folder has no such file.
inline constexpr std::size_t kVolumeUserTables = 2;
using VolumeUserTables = std::array<std::shared_ptr<const VolumeUserTable>, kVolumeUserTables>;

}  // namespace cellmirror
