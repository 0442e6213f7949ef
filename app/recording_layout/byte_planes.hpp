// A row of 16-bit numbers as differences to the one before, all low bytes before all high bytes: neighbours differ
// little, so that the compression of a chunk finds more to leave out. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt_core/base/state_bytes.hpp"

namespace cellmirror::app {

// `value(i)`: the number at i.
template <class Value>
void put_planes(StateWriter& out, std::size_t count, const Value& value) {
  std::vector<std::uint8_t> bytes(2 * count);
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t now = value(i);
    // Folded, so that small differences of either sign have a high byte of 0.
    const auto step = static_cast<std::int16_t>(static_cast<std::uint16_t>(now - before));
    const auto folded =
        static_cast<std::uint16_t>((static_cast<std::uint16_t>(step) << 1U) ^ (step < 0 ? 0xFFFFU : 0U));
    bytes[i] = static_cast<std::uint8_t>(folded);
    bytes[count + i] = static_cast<std::uint8_t>(folded >> 8U);
    before = now;
  }
  out.bytes(bytes.data(), bytes.size());
}

// `take(i, number)`. `count` is bounded by the caller. Nothing is taken where the bytes are not there.
template <class Take>
void take_planes(StateReader& in, std::size_t count, const Take& take) {
  const auto bytes = in.rest();
  in.skip(2 * count);
  if (!in.ok()) return;
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto folded =
        static_cast<std::uint16_t>(static_cast<unsigned>(bytes[i]) | static_cast<unsigned>(bytes[count + i]) << 8U);
    const auto step = static_cast<std::uint16_t>((folded >> 1U) ^ ((folded & 1U) != 0 ? 0xFFFFU : 0U));
    before = static_cast<std::uint16_t>(before + step);
    take(i, before);
  }
}

}  // namespace cellmirror::app
