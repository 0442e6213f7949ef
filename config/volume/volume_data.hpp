// A voxel volume as read from files, with what was understood of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror {

inline constexpr std::uint32_t kMostVoxelsAlong = 4096;            // of each axis
inline constexpr std::size_t kMostVoxels = std::size_t{1} << 30U;  // of a volume: 1024^3
inline constexpr double kLeastSpacing = 1e-6;                      // m
inline constexpr double kMostSpacing = 1.0;                        // m

// For people: `cellmirror volume info`.
struct VolumeFacts {
  std::string kind;                // "NRRD", "raw", "DICOM series"
  std::string encoding;            // as "gzip", or the transfer syntaxes
  std::string stored;              // type of the values in the file: "16 bit signed, little endian"
  std::string modality;            // of DICOM, as are the next ones; may be empty
  std::string manufacturer;        // with the model
  std::string series;              // UID
  std::string series_description;  // printable
  std::string order;               // how the slices were ordered
  std::vector<std::string> files;  // names, in the order of the slices where there is one file a slice
};

struct VolumeData {
  VoxelGrid grid;
  VolumeFacts facts;
  std::optional<Pose> X_PV;  // frame V in the coordinates of the file (of the patient: LPS), where it has any
};

// Refused: fewer than 2 voxels along an axis, more than the limits, or more than the free memory of this machine holds.
[[nodiscard]] Result<void> check_voxels(const std::array<std::uint64_t, 3>& size, std::size_t bytes_per_voxel);

// Along each axis, m; refused where one is no number or beyond its limits.
[[nodiscard]] Result<void> check_spacing(const Eigen::Vector3d& spacing_m);

// "512 x 512 x 120"
[[nodiscard]] std::string size_text(const std::array<std::uint32_t, 3>& size);

}  // namespace cellmirror
