// A sample as its serialized bytes.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace cellmirror::dds {

inline constexpr std::size_t kMaxPayloadBytes = 1U << 20U;
inline constexpr std::size_t kStartBytes = 20;  // who asks, of a request (service_mapping.hpp)

struct BytesSample {
  std::vector<std::byte> payload;  // encapsulation header included; empty where it was longer than kMaxPayloadBytes
  std::size_t received = 0;        // bytes that came
  // The first of them, also where the rest was too long; zeros where there are fewer.
  std::array<std::byte, kStartBytes> start{};
};

}  // namespace cellmirror::dds
