// A folder of DICOM slices as a volume.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "config/volume/volume_data.hpp"
#include "config/volume/volume_process.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror {

// The series with that UID; without one the only series. Nothing, with errors that name files, where it is refused.
// Diagnostics have no place: they are about the folder.
[[nodiscard]] std::optional<VolumeData> read_dicom_series(const std::filesystem::path& folder,
                                                          const std::string& series, Diagnostics& diagnostics,
                                                          const VolumeReader& reader = installed_volume_reader());

}  // namespace cellmirror
