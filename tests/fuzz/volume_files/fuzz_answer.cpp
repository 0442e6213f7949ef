// Any bytes as answers of the reader of slices, which a damaged file may control.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "config/volume_message/slice_message.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (const auto head = decode_slice_head(bytes)) {
    CELLMIRROR_EXPECTS(head->rows <= 0xFFFF && head->columns <= 0xFFFF && head->bits_allocated <= 64);
    CELLMIRROR_EXPECTS(std::isfinite(head->slope) && std::isfinite(head->intercept));
    CELLMIRROR_EXPECTS(head->series.size() <= kLongestSliceText);
    if (head->position) {
      for (const double along : *head->position) CELLMIRROR_EXPECTS(std::isfinite(along));
    }
    if (head->orientation) {
      for (const double along : *head->orientation) CELLMIRROR_EXPECTS(std::isfinite(along));
    }
    // What was understood is all that was there.
    CELLMIRROR_EXPECTS(decode_slice_head(encode_slice_head(*head)).has_value());
  }
  if (const auto error = decode_slice_error(bytes)) {
    for (const char byte : error->what) CELLMIRROR_EXPECTS(byte >= ' ' && byte <= '~');
  }
  return 0;
}
