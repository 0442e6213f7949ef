// Little-endian numbers in byte buffers, as CANopen sends them (CiA 301, 7.1.2), and bit fields counted from the least
// significant bit of byte 0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "rt_core/base/contract.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// `bytes` little-endian bytes at the start of `data`, zero extended; `bytes` is at most 8 and at most data.size().
[[nodiscard]] inline std::uint64_t get_le(std::span<const std::uint8_t> data, std::size_t bytes) {
  CELLMIRROR_EXPECTS(bytes <= 8 && bytes <= data.size());
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value |= std::uint64_t{data[i]} << (8 * i);
  return value;
}
[[nodiscard]] inline std::uint16_t get_le16(std::span<const std::uint8_t> data) {
  return static_cast<std::uint16_t>(get_le(data, 2));
}
[[nodiscard]] inline std::uint32_t get_le32(std::span<const std::uint8_t> data) {
  return static_cast<std::uint32_t>(get_le(data, 4));
}

inline void put_le(std::span<std::uint8_t> data, std::uint64_t value, std::size_t bytes) {
  CELLMIRROR_EXPECTS(bytes <= 8 && bytes <= data.size());
  for (std::size_t i = 0; i < bytes; ++i) data[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

// `count` bits (at most 64) from bit `first`; the caller has checked that they lie inside `data`.
[[nodiscard]] inline std::uint64_t get_bits(std::span<const std::uint8_t> data, std::size_t first, std::size_t count) {
  CELLMIRROR_EXPECTS(count <= 64 && first + count <= 8 * data.size());
  std::uint64_t value = 0;
  for (std::size_t done = 0; done < count;) {
    const std::size_t bit = first + done;
    const std::size_t take = count - done < 8 - bit % 8 ? count - done : 8 - bit % 8;
    const std::uint64_t part = (std::uint64_t{data[bit / 8]} >> (bit % 8)) & ((1U << take) - 1U);
    value |= part << done;
    done += take;
  }
  return value;
}

inline void put_bits(std::span<std::uint8_t> data, std::size_t first, std::size_t count, std::uint64_t value) {
  CELLMIRROR_EXPECTS(count <= 64 && first + count <= 8 * data.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t bit = first + i;
    const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
    const bool set = ((value >> i) & 1U) != 0;
    data[bit / 8] = static_cast<std::uint8_t>(set ? data[bit / 8] | mask : data[bit / 8] & ~mask);
  }
}

// Two's complement of `bits` bits (1..64) as a signed number.
[[nodiscard]] inline std::int64_t sign_extended(std::uint64_t raw, std::size_t bits) {
  if (bits == 0 || bits >= 64) return static_cast<std::int64_t>(raw);
  const std::uint64_t sign = std::uint64_t{1} << (bits - 1);
  raw &= (sign << 1) - 1;
  return static_cast<std::int64_t>((raw ^ sign) - sign);
}

// A classic data frame with an 11-bit identifier.
[[nodiscard]] inline CanFrame make_frame(std::uint32_t id, std::span<const std::uint8_t> data) {
  CELLMIRROR_EXPECTS(id < 0x800 && data.size() <= 8);
  CanFrame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) frame.data[i] = data[i];
  return frame;
}
[[nodiscard]] inline CanFrame make_frame(std::uint32_t id, std::initializer_list<std::uint8_t> data) {
  return make_frame(id, std::span<const std::uint8_t>(data.begin(), data.size()));
}

}  // namespace cellmirror::can
