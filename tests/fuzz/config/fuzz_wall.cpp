// Any bytes as a list of cells for a wall: findings or settings within their limits, never a crash.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "config/wall_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  Diagnostics diagnostics;
  const auto wall = parse_wall({reinterpret_cast<const char*>(data), size}, "wall.toml", AnyFile(), diagnostics);
  if (wall.has_value() != diagnostics.ok()) std::abort();
  if (!wall) return 0;
  if (wall->cells.size() > kMostWallCells) std::abort();
  for (const WallCell& cell : wall->cells) {
    if (cell.name.empty() || cell.page.find('#') != std::string::npos || cell.page.find('@') != std::string::npos)
      std::abort();
  }
  return 0;
}
