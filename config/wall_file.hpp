// wall.toml: the cells that a wall shows, and where it listens (docs/wall.md).
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "config/file_finder.hpp"
#include "config/wall_settings.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror {

inline constexpr std::size_t kLargestWallFile = std::size_t{1} << 20U;  // bytes

// Nothing where anything is wrong; all errors in one pass. `files`: for certificates that [dds.security] names.
[[nodiscard]] std::optional<WallSettings> parse_wall(std::string_view text, const std::string& file,
                                                     const FileFinder& files, Diagnostics& diagnostics);

// The file at `path`; the files that it names are in its folder.
[[nodiscard]] std::optional<WallSettings> read_wall(const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace cellmirror
