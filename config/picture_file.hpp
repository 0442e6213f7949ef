// Pictures in files: PNG and JPEG. The bytes are untrusted. Allocates; any thread. Private to this folder.
#pragma once

#include <cstddef>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror {

inline constexpr std::size_t kLargestPictureFile = 32UL << 20U;  // bytes
inline constexpr std::size_t kMostPictureBytes = 128UL << 20U;   // of all pictures of a cell, decoded (4 a pixel)

// Each edge has 1 to kLargestImageEdge pixels. A picture that ends too early or is damaged is refused as a whole.
// `room`: bytes that pixels may still take. It shrinks with each picture that is begun, damaged ones too, since they
// are as much work; one that does not fit is refused by its header alone.
[[nodiscard]] Result<Image> decode_picture(std::string_view bytes, std::size_t& room);

}  // namespace cellmirror
