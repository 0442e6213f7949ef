#include "drivers/dds/image_message.hpp"

namespace cellmirror::dds {

CdrFault decode(std::span<const std::byte> payload, CompressedImageView& message) {
  CdrReader in(payload);
  message.stamp.sec = in.read<std::int32_t>();
  message.stamp.nanosec = in.read<std::uint32_t>();
  message.frame_id = in.read_text();
  message.format = in.read_text();
  message.data = in.read_bytes();
  return in.fault();
}

void encode(const CompressedImage& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  write(message.header, writer);
  writer.write_text(message.format);
  writer.write_count(message.data.size());
  writer.write_bytes(message.data);
}

}  // namespace cellmirror::dds
