// A picture. Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror {

inline constexpr int kLargestImageEdge = 4096;  // pixels

// Rows from the top, without gaps; red, green, blue, alpha (255: the pictures are opaque).
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // width * height * 4

  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
    return rgba.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

enum class ImageFormat : std::uint8_t { jpeg, png };

struct EncodedImage {
  ImageFormat format = ImageFormat::jpeg;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;
  Timestamp posture_time;      // of the tick that it shows
  std::uint64_t sequence = 0;  // of its stream, counts from 1
};

}  // namespace cellmirror
