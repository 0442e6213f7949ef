#include "app/wall/jpeg_head.hpp"

#include <cstddef>

#include "rt_core/ports/image.hpp"

namespace cellmirror::app {

namespace {

// T.81, table B.1.
constexpr std::uint8_t kMarker = 0xFF;
constexpr std::uint8_t kStart = 0xD8;
constexpr std::uint8_t kStartOfScan = 0xDA;
constexpr std::size_t kFrameBytes =
    8;  // of a frame header up to its width: length, precision, height, width, components

// SOF0 to SOF15 without DHT, JPG and DAC, which lie among them.
bool is_frame(std::uint8_t code) {
  return code >= 0xC0 && code <= 0xCF && code != 0xC4 && code != 0xC8 && code != 0xCC;
}

int two_bytes(std::span<const std::uint8_t> bytes, std::size_t at) { return bytes[at] << 8 | bytes[at + 1]; }

}  // namespace

std::optional<JpegSize> jpeg_size(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 4 || bytes[0] != kMarker || bytes[1] != kStart) return std::nullopt;
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    if (bytes[at] != kMarker) return std::nullopt;
    const std::uint8_t code = bytes[at + 1];
    if (code == kMarker) {  // a fill byte
      ++at;
      continue;
    }
    if (code < 0xC0 || code == kStart || code == kStartOfScan || (code >= 0xD0 && code <= 0xD7)) return std::nullopt;
    const auto length = static_cast<std::size_t>(two_bytes(bytes, at + 2));
    if (length < 2) return std::nullopt;
    if (is_frame(code)) {
      if (length < kFrameBytes || at + 2 + kFrameBytes > bytes.size()) return std::nullopt;
      const JpegSize size{two_bytes(bytes, at + 7), two_bytes(bytes, at + 5)};
      const bool good =
          size.width > 0 && size.height > 0 && size.width <= kLargestImageEdge && size.height <= kLargestImageEdge;
      return good ? std::optional(size) : std::nullopt;
    }
    at += 2 + length;
  }
  return std::nullopt;
}

}  // namespace cellmirror::app
