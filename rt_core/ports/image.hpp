// A picture. Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror {

inline constexpr int kSmallestImageEdge = 16;  // pixels
inline constexpr int kLargestImageEdge = 4096;

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

// Receives pictures from one thread. Never waits.
class ImageOutput {
 public:
  virtual ~ImageOutput() = default;
  // Whether anybody would see a picture now. Any thread.
  [[nodiscard]] virtual bool watched() const = 0;
  virtual void publish_image(const EncodedImage& picture) = 0;
  // For the status, any thread: "sent", "dropped", ...
  [[nodiscard]] virtual std::vector<std::pair<std::string, std::uint64_t>> counters() const = 0;
  [[nodiscard]] virtual std::string name() const = 0;
};

}  // namespace cellmirror
