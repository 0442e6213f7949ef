#include "scripts/programs/irdata/cursor.hpp"

#include <algorithm>

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
  for (; at_ < line_.size(); ++at_) {
    const char c = line_[at_];
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') depth = std::max(depth - 1, 0);
    if (c == ',' && depth == 0) return;
  }
}

}  // namespace cellmirror::program::irdata
