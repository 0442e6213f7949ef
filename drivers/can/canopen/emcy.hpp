// Emergency messages (CiA 301, 7.2.7; error codes also CiA 402-2). Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

struct Emcy {
  std::uint8_t node = 0;
  std::uint16_t code = 0;           // 0x0000: error reset or no error
  std::uint8_t error_register = 0;  // object 0x1001
  std::array<std::uint8_t, 5> manufacturer{};
  bool operator==(const Emcy&) const = default;
};

[[nodiscard]] CanFrame encode_emcy(const Emcy& emcy);
// None for other identifiers and for lengths other than 8.
[[nodiscard]] std::optional<Emcy> decode_emcy(const CanFrame& frame);

// The most specific class of the error code that has a name: 0x8130 "heartbeat error", 0x8199 "communication".
[[nodiscard]] std::string_view emcy_words(std::uint16_t code);
// "node 3 0x8611 following error, register 0x21".
[[nodiscard]] std::string text(const Emcy& emcy);

}  // namespace cellmirror::can
