// Lines of candump log files (can-utils, `candump -l` and `-L`):
//   (1436509052.249713) vcan0 044#2A366C2BBA          classic, 11-bit identifier
//   (1436509052.249713) vcan0 1ABCDEF0##1DEADBEEF     FD with flags 1 (bit rate switch), 29-bit identifier
//   (1436509052.249713) vcan0 123#R                   remote
//   (1436509052.249713) vcan0 20000004#000C000000000000   error frame (CAN_ERR_FLAG in the identifier)
// Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// The longest line that is read; candump's own stay below 200 bytes.
inline constexpr std::size_t kCandumpLineCapacity = 512;

struct CandumpLine {
  std::int64_t time_ns = 0;  // since 1970, or since whatever the writer counted from
  std::string_view interface;
  CanFrame frame;
};

// `line` without its end of line; a carriage return at its end and a direction (R, T) behind the frame are accepted.
// The reason why not, otherwise.
[[nodiscard]] std::expected<CandumpLine, std::string_view> parse_candump_line(std::string_view line);

// The inverse, without an end of line.
[[nodiscard]] std::string format_candump_line(std::int64_t time_ns, std::string_view interface, const CanFrame& frame);

}  // namespace cellmirror::can
