#include "rt_core/base/json_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "rt_core/base/utf8.hpp"

namespace cellmirror {

namespace {

// Bytes at the start that stand for themselves: images come as long texts.
std::size_t plain_characters(std::string_view text) {
  const auto first = std::ranges::find_if(text, [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x80 || c == '"' || c == '\\';
  });
  return static_cast<std::size_t>(first - text.begin());
}

}  // namespace

void JsonWriter::separate() {
  if (!first_) text_ += ',';
  first_ = false;
  break_line();
}

void JsonWriter::break_line() {
  if (line_) text_ += '\n';
  line_ = false;
}

JsonWriter& JsonWriter::line() {
  line_ = true;
  return *this;
}

JsonWriter& JsonWriter::begin(char bracket) {
  separate();
  text_ += bracket;
  first_ = true;
  return *this;
}

JsonWriter& JsonWriter::end(char bracket) {
  break_line();
  text_ += bracket;
  first_ = false;
  return *this;
}

JsonWriter& JsonWriter::raw(std::string_view text) {
  separate();
  text_ += text;
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  value(name);
  text_ += ':';
  first_ = true;
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  if (!std::isfinite(number)) return null();
  separate();
  if (digits_ == kExact) {
    fmt::format_to(std::back_inserter(text_), "{}", number);
  } else {
    fmt::format_to(std::back_inserter(text_), "{:.{}g}", number, digits_);
  }
  return *this;
}

JsonWriter& JsonWriter::fixed(double number, int decimals) {
  return std::isfinite(number) ? raw(fmt::format("{:.{}f}", number, decimals)) : null();
}

JsonWriter& JsonWriter::value(const Eigen::Vector3d& vector) {
  begin_array();
  for (const double number : {vector.x(), vector.y(), vector.z()}) value(number);
  return end_array();
}

JsonWriter& JsonWriter::value(std::span<const std::string> texts) {
  begin_array();
  for (const std::string& text : texts) value(text);
  return end_array();
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  text_ += '"';
  while (!text.empty()) {
    if (const std::size_t plain = plain_characters(text); plain > 0) {
      text_ += text.substr(0, plain);
      text.remove_prefix(plain);
      continue;
    }
    const auto character = utf8_character(text);
    if (!character) {
      text_ += "\xEF\xBF\xBD";  // U+FFFD, the replacement character
      text.remove_prefix(1);
      continue;
    }
    if (character->code == '"' || character->code == '\\') {
      text_ += '\\';
      text_ += static_cast<char>(character->code);
    } else if (character->code < 0x20) {
      fmt::format_to(std::back_inserter(text_), "\\u{:04x}", static_cast<unsigned>(character->code));
    } else {
      text_ += text.substr(0, character->bytes);
    }
    text.remove_prefix(character->bytes);
  }
  text_ += '"';
  return *this;
}

}  // namespace cellmirror
