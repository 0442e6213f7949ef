#include "app/report/json_builder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "rt_core/base/utf8.hpp"

namespace cellmirror::app {

void JsonBuilder::separate() {
  if (!first_) text_ += ',';
  first_ = false;
}

JsonBuilder& JsonBuilder::begin(char bracket) {
  separate();
  text_ += bracket;
  first_ = true;
  return *this;
}

JsonBuilder& JsonBuilder::end(char bracket) {
  text_ += bracket;
  first_ = false;
  return *this;
}

JsonBuilder& JsonBuilder::raw(std::string_view text) {
  separate();
  text_ += text;
  return *this;
}

JsonBuilder& JsonBuilder::key(std::string_view name) {
  value(name);
  text_ += ':';
  first_ = true;
  return *this;
}

JsonBuilder& JsonBuilder::value(double number) {
  if (!std::isfinite(number)) return null();
  separate();
  fmt::format_to(std::back_inserter(text_), "{:.9g}", number);
  return *this;
}

JsonBuilder& JsonBuilder::fixed(double number, int decimals) {
  return std::isfinite(number) ? raw(fmt::format("{:.{}f}", number, decimals)) : null();
}

JsonBuilder& JsonBuilder::value(const Eigen::Vector3d& vector) {
  begin_array();
  for (const double number : {vector.x(), vector.y(), vector.z()}) value(number);
  return end_array();
}

JsonBuilder& JsonBuilder::value(std::string_view text) {
  separate();
  text_ += '"';
  while (!text.empty()) {
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

}  // namespace cellmirror::app
