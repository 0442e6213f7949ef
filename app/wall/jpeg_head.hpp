// Whether bytes look like a JPEG file that a browser may be given: its marks up to the size of the picture (ITU-T T.81,
// annex B). Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace cellmirror::app {

struct JpegSize {
  int width = 0;  // pixels
  int height = 0;

  bool operator==(const JpegSize&) const = default;
};

// None: it does not begin as a JPEG, has no frame header, or an edge is 0 or beyond kLargestImageEdge.
[[nodiscard]] std::optional<JpegSize> jpeg_size(std::span<const std::uint8_t> bytes);

}  // namespace cellmirror::app
