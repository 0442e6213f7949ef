// UTF-8 as RFC 3629 (section 4) defines it.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace cellmirror {

// Bytes of the well-formed character at the start of `text` and its code point; none if invalid (overlong forms,
// surrogates, beyond U+10FFFF, cut short, empty).
struct Utf8Character {
  std::size_t bytes = 0;
  char32_t code = 0;
};
[[nodiscard]] std::optional<Utf8Character> utf8_character(std::string_view text);

// Whether all of it is well-formed.
[[nodiscard]] bool is_utf8(std::string_view text);

// The control characters of ASCII (C0, DEL) and of ISO 6429 (C1): of no use in one line, in a log or on a terminal.
[[nodiscard]] constexpr bool is_control_character(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0);
}

// The longest part of `text` from its start that has at most `most` bytes and ends between characters.
[[nodiscard]] std::string_view cut_utf8(std::string_view text, std::size_t most);

// As a font can draw it in one line: each control character, and each byte that is part of no character, becomes a "?";
// behind `most_characters` an ellipsis stands for the rest.
[[nodiscard]] std::string drawable_utf8(std::string_view text,
                                        std::size_t most_characters = std::numeric_limits<std::size_t>::max());
inline constexpr std::string_view kUtf8Ellipsis = "\xE2\x80\xA6";

}  // namespace cellmirror
