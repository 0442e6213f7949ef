// The decoded pixels of a DICOM file.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "config/volume_message/slice_message.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

struct SlicePixels {
  SlicePixelsHead head;
  std::vector<char> values;  // of head.type, rows x columns
};

// One frame with one sample of 8 or 16 bits a pixel. Signs are extended from the high bit, other bits are cleared.
[[nodiscard]] Result<SlicePixels> read_slice_pixels(std::string_view bytes);

}  // namespace cellmirror
