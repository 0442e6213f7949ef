// Deformable objects (.mpo): TOML, the keys are described in docs/cell-files.md. Any bytes are allowed as text. Not for
// the tick.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "config/file_finder.hpp"
#include "config/tissue_setup.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror {

// The object at the origin of the world, or nothing and all diagnostics. Its mesh and its tetrahedra are read by
// `files`; where these give none, the surface is empty. `file`: path for messages, whose last part is the object's
// name.
[[nodiscard]] std::optional<tissue::ObjectDescription> parse_object(std::string_view text, const std::string& file,
                                                                    const FileFinder& files, Diagnostics& diagnostics);
// The same of a file.
[[nodiscard]] std::optional<tissue::ObjectDescription> read_object(const std::filesystem::path& path,
                                                                   const FileFinder& files, Diagnostics& diagnostics);

}  // namespace cellmirror
