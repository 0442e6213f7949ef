// The files of users' look-up tables for voxel volumes: USER1_LUT.lut and USER2_LUT.lut in envlib/ of the cell folder,
// whose rows docs/volumes.md describes. Not for the tick.
#pragma once

#include <cstddef>
#include <string>

#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/volume_user_table.hpp"

namespace cellmirror {

// "envlib/USER1_LUT.lut" of the first, for messages.
[[nodiscard]] std::string volume_table_file(std::size_t user_table);

// A table without a file is null. The error is the first one of a file, with its place, and how many there are.
[[nodiscard]] Result<VolumeUserTables> load_volume_tables(const KismetHome& home);

}  // namespace cellmirror
