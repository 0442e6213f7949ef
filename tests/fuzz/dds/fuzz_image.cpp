// Any bytes as a picture: what is decoded lies within them, and is the same again once it is encoded.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "drivers/dds/image_message.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror::dds;
  const std::span<const std::byte> payload(reinterpret_cast<const std::byte*>(data), size);
  CompressedImageView seen;
  if (decode(payload, seen) != CdrFault::none) return 0;
  if (seen.data.size() > size) std::abort();
  CompressedImage message;
  message.header = {seen.stamp, std::string(seen.frame_id)};
  message.format = seen.format;
  message.data = seen.data;
  std::vector<std::byte> bytes;
  encode(message, bytes);
  CompressedImageView again;
  if (decode(bytes, again) != CdrFault::none || !std::ranges::equal(again.data, seen.data)) std::abort();
  return 0;
}
