#include "scripts/programs/irdata/cursor.hpp"

#include <algorithm>
#include <cstring>

namespace cellmirror::program::irdata {

std::string_view Cursor::number(bool& whole) {
  const std::size_t begin = at_;
  whole = true;
  while (is_digit(peek())) ++at_;
  const bool digits_before = at_ > begin;
  if (peek() == '.' && (digits_before || is_digit(peek_behind()))) {
    whole = false;
    ++at_;
    while (is_digit(peek())) ++at_;
  }
  if (at_ == begin) return {};
  if (peek() == 'e' || peek() == 'E') {
    std::size_t digit = at_ + 1;
    if (digit < line_.size() && (line_[digit] == '+' || line_[digit] == '-')) ++digit;
    if (digit < line_.size() && is_digit(line_[digit])) {
      whole = false;
      at_ = digit;
      while (is_digit(peek())) ++at_;
    }
  }
  return line_.substr(begin, at_ - begin);
}

void Cursor::skip_parameter(std::size_t begin) {
  at_ = begin;
  int depth = 0;
  bool quoted = false;
  for (; at_ < line_.size(); ++at_) {
    const char c = line_[at_];
    if (c == '\'') quoted = !quoted;
    if (quoted) continue;
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') depth = std::max(depth - 1, 0);
    if (c == ',' && depth == 0) return;
  }
}

std::size_t find_comment(std::string_view line, std::size_t from) {
  if (from >= line.size()) return std::string_view::npos;
  const char* begin = line.data() + from;
  const std::size_t size = line.size() - from;
  const void* semicolon = std::memchr(begin, ';', size);
  if (semicolon == nullptr) return std::string_view::npos;
  if (std::memchr(begin, '\'', size) == nullptr)
    return static_cast<std::size_t>(static_cast<const char*>(semicolon) - line.data());
  bool quoted = false;
  for (std::size_t at = from; at < line.size(); ++at) {
    if (line[at] == '\'') quoted = !quoted;
    if (line[at] == ';' && !quoted) return at;
  }
  return std::string_view::npos;
}

}  // namespace cellmirror::program::irdata
