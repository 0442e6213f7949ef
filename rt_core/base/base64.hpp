// Bytes as text, RFC 4648 section 4, with padding.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cellmirror {

[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);
// None where the text is nothing that base64() returns: other characters, wrong length or padding.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

}  // namespace cellmirror
