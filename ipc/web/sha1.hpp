// SHA-1 (FIPS 180-4) and Base64 (RFC 4648), which the opening of a WebSocket asks for (RFC 6455, section 4.2.2). SHA-1
// protects nothing here: it only shows that both sides speak WebSocket.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace cellmirror::web {

[[nodiscard]] std::array<std::uint8_t, 20> sha1(std::string_view bytes);
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace cellmirror::web
