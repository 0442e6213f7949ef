// The head of a NRRD file (nearly raw raster data, versions 1 to 5) with three axes of space. Written from the public
// definition of the format.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/volume/voxel_values.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/pose.hpp"

namespace cellmirror {

inline constexpr std::size_t kLargestNrrdHead = std::size_t{256} << 10U;  // bytes

struct NrrdHead {
  VoxelFormat format;
  Eigen::Vector3d spacing_m = Eigen::Vector3d::Constant(1e-3);  // without a unit: mm
  bool gzip = false;
  std::uint64_t skip_bytes = 0;         // before the data, in the file that holds them
  std::uint32_t skip_lines = 0;         // before these
  bool at_end = false;                  // `byte skip: -1`
  std::vector<std::string> data_files;  // as named; empty: the data follow the head
  std::size_t data_offset = 0;          // of data that follow the head
  std::optional<Pose> X_PV;             // in the space of the file
  std::string space;                    // its name; may be empty
};

// `text`: the file's first bytes, at most kLargestNrrdHead of them. Warnings for what is not used; nothing, with
// errors and their lines, where it is refused: other dimensions, sheared axes, other types, encodings and units.
[[nodiscard]] std::optional<NrrdHead> parse_nrrd_head(std::string_view text, const std::string& file,
                                                      Diagnostics& diagnostics);

}  // namespace cellmirror
