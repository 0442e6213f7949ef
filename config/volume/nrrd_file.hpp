// NRRD files (.nrrd, .nhdr).
#pragma once

#include <filesystem>
#include <optional>

#include "config/volume/volume_data.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// Nothing, with errors, where it is refused. Data of a detached head lie in its folder or below.
[[nodiscard]] std::optional<VolumeData> read_nrrd(const std::filesystem::path& path, Diagnostics& diagnostics);

// As NRRD with raw values, which other programs read too: slope and intercept are applied, to integers of 16 bits where
// all values fit, else to floating point. An existing file is replaced as a whole or left as it is.
[[nodiscard]] Result<void> write_nrrd(const VolumeData& volume, const std::filesystem::path& path);

}  // namespace cellmirror
