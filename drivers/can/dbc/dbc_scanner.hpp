// Words, numbers and strings of a DBC with their places. For the reader alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cellmirror::can {

class DbcScanner {
 public:
  explicit DbcScanner(std::string_view text) : text_(text) {}

  [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
  [[nodiscard]] char peek() const { return at_end() ? '\0' : text_[at_]; }
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] int column() const { return static_cast<int>(at_ - line_start_) + 1; }

  void advance() {
    if (at_end()) return;
    if (text_[at_] == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    }
    ++at_;
  }
  void skip_blanks() {  // within the line
    while (peek() == ' ' || peek() == '\t' || peek() == '\r') advance();
  }
  void skip_space() {
    while (peek() == ' ' || peek() == '\t' || peek() == '\r' || peek() == '\n') advance();
  }
  void skip_line() {
    while (!at_end() && peek() != '\n') advance();
  }
  [[nodiscard]] bool at_line_end() {
    skip_blanks();
    return at_end() || peek() == '\n';
  }
  // Takes the character where it is next (after blanks).
  bool take(char c) {
    skip_blanks();
    if (peek() != c || at_end()) return false;
    advance();
    return true;
  }
  // Letters, digits and underscores; empty where there is none.
  std::string_view word() {
    skip_blanks();
    return run(
        [](char c) { return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
  }
  // What a number may consist of; the caller parses it.
  std::string_view number_text() {
    skip_blanks();
    return run(
        [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E'; });
  }
  // A string in quotation marks, which may hold line ends and \". None where it does not start or does not end.
  std::optional<std::string_view> string() {
    skip_blanks();
    if (peek() != '"' || at_end()) return {};
    advance();
    const std::size_t first = at_;
    while (!at_end() && peek() != '"') {
      if (peek() == '\\') advance();
      advance();
    }
    if (at_end()) return {};
    const std::string_view text = text_.substr(first, at_ - first);
    advance();
    return text;
  }

 private:
  template <class Fits>
  std::string_view run(Fits fits) {
    const std::size_t first = at_;
    while (!at_end() && fits(peek())) advance();
    return text_.substr(first, at_ - first);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  int line_ = 1;
};

}  // namespace cellmirror::can
