// Read position in a record: its characters, names and numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scripts/programs/irdata/words.hpp"

namespace cellmirror::program::irdata {

class Cursor {
 public:
  Cursor() = default;
  explicit Cursor(std::string_view line) : line_(line) {}

  void skip_blank() {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t' || line_[at_] == '\r')) ++at_;
  }
  [[nodiscard]] bool at_end() const { return at_ >= line_.size(); }
  // The next character, 0 at the end.
  [[nodiscard]] char peek() const { return at_ < line_.size() ? line_[at_] : '\0'; }
  [[nodiscard]] char peek_behind() const { return at_ + 1 < line_.size() ? line_[at_ + 1] : '\0'; }
  void skip() { ++at_; }
  // Passes over blanks and, where it comes next, over this character.
  bool take(char c) {
    skip_blank();
    if (at_ >= line_.size() || line_[at_] != c) return false;
    ++at_;
    return true;
  }
  // A name or a word; empty where none begins here.
  std::string_view name() {
    const std::size_t begin = at_;
    if (at_ < line_.size() && is_letter(line_[at_])) {
      ++at_;
      while (at_ < line_.size() && is_name_part(line_[at_])) ++at_;
    }
    return line_.substr(begin, at_ - begin);
  }
  // All characters of a number without sign: digits, a point, an exponent; empty where none begins here.
  std::string_view number(bool& whole);

  [[nodiscard]] std::size_t at() const { return at_; }
  void go_to(std::size_t at) { at_ = at; }
  // From 1, in bytes of the line.
  [[nodiscard]] std::uint32_t column() const { return static_cast<std::uint32_t>(at_) + 1; }
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::string_view rest() const { return line_.substr(at_ < line_.size() ? at_ : line_.size()); }
  // Cuts off what is a comment.
  void end_at(std::size_t end) { line_ = line_.substr(0, end); }
  // To the comma in front of the next parameter, from the begin of one; commas within brackets are passed over.
  void skip_parameter(std::size_t begin);

 private:
  std::string_view line_;
  std::size_t at_ = 0;
};

}  // namespace cellmirror::program::irdata
