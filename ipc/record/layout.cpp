#include "ipc/record/layout.hpp"

#include <zlib.h>

#include <algorithm>

namespace cellmirror::mcap {

std::string_view word(Compression compression) {
  switch (compression) {
    case Compression::none:
      return "";
    case Compression::lz4:
      return "lz4";
    case Compression::zstd:
      return "zstd";
  }
  return "";
}

void Statistics::count(const Message& message) {
  start_time = messages == 0 ? message.log_time : std::min(start_time, message.log_time);
  end_time = std::max(end_time, message.log_time);
  ++messages;
  ++channel_messages[message.channel];
}

std::uint32_t crc32(View data, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const unsigned char*>(data.data()), data.size()));
}

}  // namespace cellmirror::mcap
