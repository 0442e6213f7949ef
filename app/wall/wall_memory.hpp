// The file in which a wall keeps which cells were there, so that one that is silent is still shown after a restart of
// the wall.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/wall/wall_cells.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

inline constexpr std::size_t kLargestWallMemory = std::size_t{4} << 20U;  // bytes

[[nodiscard]] std::string wall_memory_text(const std::vector<RememberedCell>& cells);
// Of any bytes. Fails where it is no such document; at most kMostWallTiles cells are taken, those without a name are
// left out, and times that cannot be are taken as never heard and left out.
[[nodiscard]] Result<std::vector<RememberedCell>> parse_wall_memory(std::string_view text);

// A file that is not there is empty.
[[nodiscard]] Result<std::vector<RememberedCell>> read_wall_memory(const std::filesystem::path& file);
// As a whole: beside it first, mode 0600, then in its place. Waits for the disk.
[[nodiscard]] Result<void> write_wall_memory(const std::filesystem::path& file,
                                             const std::vector<RememberedCell>& cells);

}  // namespace cellmirror::app
