// Any bytes as the memory of a wall: refused, or cells that are the same after they were written and read again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "app/wall/wall_memory.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror::app;
  const auto cells = parse_wall_memory({reinterpret_cast<const char*>(data), size});
  if (!cells) return 0;
  if (cells->size() > kMostWallTiles) std::abort();
  const auto again = parse_wall_memory(wall_memory_text(*cells));
  if (!again || *again != *cells) std::abort();
  return 0;
}
