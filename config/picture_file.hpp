// Pictures in files: PNG and JPEG. Nothing of the bytes is believed. Takes memory; any thread. Private to this folder.
#pragma once

#include <cstddef>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror {

inline constexpr std::size_t kLargestPictureFile = 32UL << 20U;  // bytes

// Each edge has 1 to kLargestImageEdge pixels. A picture that ends too early or is damaged is refused as a whole.
[[nodiscard]] Result<Image> decode_picture(std::string_view bytes);

}  // namespace cellmirror
