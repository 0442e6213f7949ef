// SHA-1 (FIPS 180-4), which the opening handshake of a WebSocket uses (RFC 6455, section 4.2.2). It protects nothing
// here: it only proves that both sides speak WebSocket.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace cellmirror::web {

[[nodiscard]] std::array<std::uint8_t, 20> sha1(std::string_view bytes);

}  // namespace cellmirror::web
