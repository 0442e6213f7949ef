// UTF-8 as RFC 3629 (section 4) defines it.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace cellmirror {

// Bytes of the well-formed character at the start of `text` and its code point; none where there is none (overlong
// forms, surrogates, beyond U+10FFFF, cut short, empty).
struct Utf8Character {
  std::size_t bytes = 0;
  char32_t code = 0;
};
[[nodiscard]] std::optional<Utf8Character> utf8_character(std::string_view text);

// The longest part of `text` from its start that has at most `most` bytes and ends between characters.
[[nodiscard]] std::string_view cut_utf8(std::string_view text, std::size_t most);

}  // namespace cellmirror
