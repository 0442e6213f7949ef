#include "drivers/dds/image_message.hpp"

namespace cellmirror::dds {

void encode(const CompressedImage& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  write(message.header, writer);
  writer.write_text(message.format);
  writer.write_count(message.data.size());
  writer.write_bytes(message.data);
}

}  // namespace cellmirror::dds
