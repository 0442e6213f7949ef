// Splits SCRIPT text into words. Handles comment lines, line ends and separators, but no commands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "scripts/lang/parsed_command.hpp"

namespace cellmirror::script {

struct Token {
  std::string_view text;
  Position begin;
  std::uint8_t commas_before = 0;  // number of commas before it (255: that many or more)
  bool first_in_line = false;
  bool plain = true;  // printable ASCII only
};

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  // Passes over blanks, line ends and comment lines.
  void skip_blank();
  [[nodiscard]] bool at_end() const { return offset_ >= text_.size(); }
  [[nodiscard]] bool at_terminator() const { return !at_end() && text_[offset_] == ';'; }
  void skip_terminator() { ++offset_; }
  [[nodiscard]] Position position() const { return {offset_, line_, static_cast<int>(offset_ - line_start_) + 1}; }
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] bool passed_comment() const { return passed_comment_; }

  // The next word of the command; false at ';' and at the end of the text. Commas before the word are counted.
  bool word(Token& token);
  // Commas after the last word of a command: call it after word() returned false.
  [[nodiscard]] std::size_t trailing_commas() const { return commas_; }

  // The rest of the command up to ';' or the end of the text, with comment lines and line ends in it, without the
  // blanks around it.
  std::string_view rest_of_command();

  // The rest of the text, with every ';' in it but one at its end, without the blanks around it: of a message, which no
  // ';' delimits (manual 1.1).
  std::string_view rest_of_text();

  // Skips to after the next ';', or to the end, to continue after an error.
  void skip_command();
  // Behind a UTF-8 byte order mark and a first line that is the format tag RBv01r01.
  void skip_file_header();

 private:
  void new_line() {
    ++line_;
    line_start_ = offset_;
  }

  std::string_view text_;
  std::size_t offset_ = 0;
  std::size_t line_start_ = 0;
  std::size_t commas_ = 0;
  int line_ = 1;
  int word_line_ = 0;  // of the last word
  bool passed_comment_ = false;
};

// Raw text of several lines (Lexer::rest_of_command) as one line: comment lines dropped, each line end one blank.
// Allocates. `raw` must not begin within a comment line.
[[nodiscard]] std::string joined_lines(std::string_view raw);

}  // namespace cellmirror::script
