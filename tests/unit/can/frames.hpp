// Frames written by hand, for the CAN tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <ostream>
#include <vector>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror {

using Frames = std::vector<CanFrame>;

inline CanFrame frame(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame result;
  result.id = id;
  for (const int byte : bytes) result.data[result.length++] = static_cast<std::uint8_t>(byte);
  return result;
}

inline CanFrame extended_frame(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame result = frame(id, bytes);
  result.extended = true;
  return result;
}

inline bool operator==(const CanFrame& a, const CanFrame& b) {
  return a.id == b.id && a.extended == b.extended && a.remote == b.remote && a.error == b.error && a.fd == b.fd &&
         a.bit_rate_switch == b.bit_rate_switch && a.error_state_indicator == b.error_state_indicator &&
         a.length == b.length && a.data == b.data;
}

inline std::ostream& operator<<(std::ostream& out, const CanFrame& f) {
  out << std::hex << f.id << (f.extended ? "x" : "") << (f.remote ? "R" : "") << (f.error ? "E" : "")
      << (f.fd ? "F" : "") << "[";
  for (const std::uint8_t b : f.payload()) out << " " << static_cast<unsigned>(b);
  return out << " ]" << std::dec;
}

}  // namespace cellmirror
