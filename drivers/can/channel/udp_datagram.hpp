// python-can's udp_multicast format: one MessagePack map a datagram (python-can, interfaces/udp_multicast; MessagePack
// specification). Pure functions, bounded, hand-written for exactly this map.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string_view>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// Longest datagram that is written (an FD frame of 64 bytes takes 220) and longest that is read.
inline constexpr std::size_t kUdpDatagramCapacity = 512;

struct UdpDatagram {
  std::array<std::uint8_t, kUdpDatagramCapacity> bytes{};
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::uint8_t> view() const { return {bytes.data(), size}; }
};

// The eleven keys in python-can's order; `timestamp_s` is seconds since 1970, overwritten by the receiver.
[[nodiscard]] UdpDatagram encode_udp_datagram(const CanFrame& frame, double timestamp_s);

// Keys in any order; missing ones have python-can's defaults (an extended identifier, 0, no data). Refused with a
// reason, as python-can would raise: unknown keys, wrong types, an identifier, length or flag that does not fit the
// kind of frame, bytes behind the map.
[[nodiscard]] std::expected<CanFrame, std::string_view> decode_udp_datagram(std::span<const std::uint8_t> datagram);

}  // namespace cellmirror::can
