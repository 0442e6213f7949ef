// A sample as its serialized bytes.
#pragma once

#include <cstddef>
#include <vector>

namespace cellmirror::dds {

inline constexpr std::size_t kMaxPayloadBytes = 1U << 20U;

struct BytesSample {
  std::vector<std::byte> payload;  // encapsulation header included; empty where it was longer than kMaxPayloadBytes
  std::size_t received = 0;        // bytes that came
};

}  // namespace cellmirror::dds
