// Voxel volumes from any source: a folder of DICOM slices, a NRRD file (.nrrd, .nhdr), or a head in TOML (.toml) of raw
// data. Not for the tick; any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "config/volume/raw_file.hpp"
#include "config/volume/volume_data.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror {

struct VolumeRequest {
  std::string source;              // as named
  std::string series;              // UID of a DICOM series; empty: the only one
  std::optional<bool> hounsfield;  // whether the values are Hounsfield units; none: what the source says
  std::string name;                // of the grid
  bool operator<(const VolumeRequest& other) const;
};

// Nothing, with errors, where it is refused. Diagnostics without a line are about the source as a whole.
[[nodiscard]] std::optional<VolumeData> read_volume(const std::filesystem::path& path, const VolumeRequest& request,
                                                    Diagnostics& diagnostics);

inline constexpr std::size_t kLargestRawHead = std::size_t{64} << 10U;  // bytes

// The head of raw data: docs/cell-files.md, "Volumes". Opens no file.
[[nodiscard]] std::optional<RawVolumeHead> parse_raw_volume_head(std::string_view text, const std::string& file,
                                                                 Diagnostics& diagnostics);

}  // namespace cellmirror
