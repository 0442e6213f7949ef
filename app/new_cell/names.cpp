#include "app/new_cell/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/utf8.hpp"

namespace cellmirror::app {

namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

}  // namespace

bool is_plain_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxNameLength && name.front() != '-' &&
         std::all_of(name.begin(), name.end(), is_plain);
}

std::string plain_file_name(std::string_view name) {
  constexpr std::size_t kLongest = 100;
  if (name.size() > kLongest) name.remove_prefix(name.size() - kLongest);
  std::string plain(name);
  for (char& c : plain) {
    if (!is_plain(c) && c != '.') c = '_';
  }
  if (plain.empty()) return "_";
  if (plain.front() == '.' || plain.front() == '-') plain.front() = '_';
  return plain;
}

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  while (!text.empty()) {
    const std::optional<Utf8Character> character = utf8_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    if (!character) {
      out += "\\ufffd";  // a byte of no character, which TOML refuses
    } else if (character->code == U'"' || character->code == U'\\') {
      out += '\\';
      out += text.front();
    } else if (is_control_character(character->code)) {
      out += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(character->code));
    } else {
      out += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return out + '"';
}

std::string number_text(double value) {
  std::string text = fmt::format("{}", value == 0.0 ? 0.0 : value);
  // TOML tells numbers from integers by the point or the exponent; keys for numbers take both.
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace cellmirror::app
