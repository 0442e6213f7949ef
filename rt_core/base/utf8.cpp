#include "rt_core/base/utf8.hpp"

namespace cellmirror {

std::optional<Utf8Character> utf8_character(std::string_view text) {
  if (text.empty()) return std::nullopt;
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return Utf8Character{1, lead};
  std::size_t bytes = 0;
  char32_t code = 0;
  char32_t smallest = 0;
  if (lead >= 0xC0 && lead < 0xE0) {
    bytes = 2, code = lead & 0x1Fu, smallest = 0x80;
  } else if (lead >= 0xE0 && lead < 0xF0) {
    bytes = 3, code = lead & 0x0Fu, smallest = 0x800;
  } else if (lead >= 0xF0 && lead < 0xF8) {
    bytes = 4, code = lead & 0x07u, smallest = 0x10000;
  } else {
    return std::nullopt;
  }
  if (text.size() < bytes) return std::nullopt;
  for (std::size_t i = 1; i < bytes; ++i) {
    const auto next = static_cast<unsigned char>(text[i]);
    if ((next & 0xC0u) != 0x80u) return std::nullopt;
    code = (code << 6u) | (next & 0x3Fu);
  }
  if (code < smallest || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return std::nullopt;
  return Utf8Character{bytes, code};
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const auto character = utf8_character(text);
    if (!character) return false;
    text.remove_prefix(character->bytes);
  }
  return true;
}

std::string_view cut_utf8(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;
  return text.substr(0, end);
}

std::string drawable_utf8(std::string_view text, std::size_t most_characters) {
  std::string out;
  for (std::size_t count = 0; !text.empty(); ++count) {
    if (count == most_characters) return out.append(kUtf8Ellipsis);
    const auto character = utf8_character(text);
    if (character && !is_control_character(character->code)) {
      out += text.substr(0, character->bytes);
    } else {
      out += '?';
    }
    text.remove_prefix(character ? character->bytes : 1);
  }
  return out;
}

}  // namespace cellmirror
