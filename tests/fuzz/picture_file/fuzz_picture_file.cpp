// Any bytes as a picture on a mesh: a whole picture of sensible size, or a reason.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "config/picture_file.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  std::size_t room = kMostPictureBytes;
  const auto picture = decode_picture({reinterpret_cast<const char*>(data), size}, room);
  CELLMIRROR_EXPECTS(room <= kMostPictureBytes);
  if (!picture) {
    CELLMIRROR_EXPECTS(!picture.error().what.empty());
    return 0;
  }
  CELLMIRROR_EXPECTS(picture->width > 0 && picture->width <= kLargestImageEdge);
  CELLMIRROR_EXPECTS(picture->height > 0 && picture->height <= kLargestImageEdge);
  CELLMIRROR_EXPECTS(picture->rgba.size() == std::size_t{4} * static_cast<std::size_t>(picture->width) *
                                                 static_cast<std::size_t>(picture->height));
  CELLMIRROR_EXPECTS(picture->rgba.size() == kMostPictureBytes - room);
  return 0;
}
