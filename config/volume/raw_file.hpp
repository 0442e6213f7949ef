// Raw data with a head of ours that says what they are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/volume/volume_data.hpp"
#include "config/volume/voxel_values.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// Content of the head (config/raw_volume_head.hpp reads it).
struct RawVolumeHead {
  std::vector<std::string> files;  // names beside the head: one, or as many as there are slices
  VoxelFormat format;              // u8, s16 or u16
  std::uint64_t header_bytes = 0;  // before the data of each file
  bool gzip = false;               // one file
  Eigen::Vector3d spacing_m = Eigen::Vector3d::Constant(1e-3);
  double slope = 1;
  double intercept = 0;
  bool hounsfield = false;
};

// `head_file`: the path of the head.
[[nodiscard]] Result<VolumeData> read_raw_volume(const RawVolumeHead& head, const std::filesystem::path& head_file);

}  // namespace cellmirror
