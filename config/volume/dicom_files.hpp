// The files of a folder of DICOM slices, and the series among them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "config/volume/volume_process.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror {

inline constexpr std::size_t kMostFolderFiles = 8192;

struct SliceFile {
  std::filesystem::path path;
  std::string name;  // printable
  SliceHead head;
};

// The slices of the series with that UID, or of the only one, by name of file. Read: regular files of the folder
// itself. Not read: links, folders, hidden files, a DICOMDIR (it names other files), files that are no DICOM images,
// localizers; each kind is a warning. Empty, with errors, where there is no series, or several without a UID.
[[nodiscard]] std::vector<SliceFile> find_series(const std::filesystem::path& folder, const std::string& series,
                                                 VolumeProcess& process, Diagnostics& diagnostics);

}  // namespace cellmirror
