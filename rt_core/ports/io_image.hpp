// The inputs and outputs of an I/O node that a controller reads and writes, as they are at one moment. Plain data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cellmirror {

inline constexpr std::size_t kIoBits = 32;      // digital inputs, and as many outputs
inline constexpr std::size_t kIoAnalogues = 8;  // analogue inputs

struct IoInputs {
  std::uint32_t digital = 0;  // bit i: input i
  std::array<std::int16_t, kIoAnalogues> analogue{};
};

struct IoOutputs {
  std::uint32_t digital = 0;  // bit i: output i
};

}  // namespace cellmirror
