// A sample as its serialized bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/dds/message/dds_message.hpp"

namespace cellmirror::dds {

struct BytesSample {
  std::vector<std::byte> payload;  // encapsulation header included; empty where it was longer than kMaxPayloadBytes
  std::size_t received = 0;        // bytes that came
  // The first of them, also where the rest was too long; zeros where there are fewer.
  std::array<std::uint8_t, kStartBytes> start{};
};

}  // namespace cellmirror::dds
