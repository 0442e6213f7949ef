// Numbers at byte offsets, little-endian whatever the machine. The caller has checked the bounds.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/contract.hpp"

namespace cellmirror::little_endian {

template <class Number>
void put(std::span<std::byte> bytes, std::size_t offset, Number value) {
  CELLMIRROR_EXPECTS(offset + sizeof(Number) <= bytes.size());
  auto raw = std::bit_cast<std::array<std::byte, sizeof(Number)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  std::copy(raw.begin(), raw.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
}

template <class Number>
[[nodiscard]] Number get(std::span<const std::byte> bytes, std::size_t offset) {
  CELLMIRROR_EXPECTS(offset + sizeof(Number) <= bytes.size());
  std::array<std::byte, sizeof(Number)> raw;
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), raw.size(), raw.begin());
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

}  // namespace cellmirror::little_endian
