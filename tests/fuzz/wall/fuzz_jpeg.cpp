// Any bytes as a picture for the wall: a size within bounds, or none.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "app/wall/jpeg_head.hpp"
#include "rt_core/ports/image.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  const auto found = app::jpeg_size({data, size});
  if (found &&
      (found->width < 1 || found->height < 1 || found->width > kLargestImageEdge || found->height > kLargestImageEdge))
    std::abort();
  return 0;
}
