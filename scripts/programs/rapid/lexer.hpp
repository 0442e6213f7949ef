// Splits the text of a program into tokens, one ahead of the parser. No grammar. Views point into the text, which must
// outlive them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/programs/program/script_comment.hpp"

namespace cellmirror::program::rapid {

enum class TokenKind : std::uint8_t {
  end_of_text,
  word,        // a name, or a word of the language: RAPID tells them apart by their place
  number,      // `value`
  text,        // "..."; with its quotes
  sign,        // `sign`
  bad_number,  // begins like a number but is none, or out of range
  bad_text,    // a text that does not end in its line
  bad_byte,
};

enum class Sign : std::uint8_t {
  none,
  becomes,  // :=
  equal,
  not_equal,
  less,
  less_equal,
  greater,
  greater_equal,
  plus,
  minus,
  times,
  divide,
  open,
  close,
  open_list,  // [
  close_list,
  open_index,  // {
  close_index,
  comma,
  semicolon,
  colon,
  dot,
  backslash,
};

struct Token {
  std::string_view text;
  std::uint32_t line = 1;
  std::uint32_t column = 1;  // in bytes
  TokenKind kind = TokenKind::end_of_text;
  Sign sign = Sign::none;
  bool begins_line = false;
  double value = 0;

  // A word, without regard to case. `upper`: in upper case.
  [[nodiscard]] bool is(std::string_view upper) const;
};

class Lexer {
 public:
  // The header %%% ... %%% that files of a controller begin with is skipped.
  explicit Lexer(std::string_view text);

  [[nodiscard]] const Token& token() const { return token_; }
  [[nodiscard]] bool at(Sign sign) const { return token_.sign == sign; }
  [[nodiscard]] bool at(std::string_view upper) const { return token_.is(upper); }
  [[nodiscard]] bool at_end() const { return token_.kind == TokenKind::end_of_text; }
  void advance();
  // Passes over a number, which may have a sign, that is followed by ',' or ']' in its line: most values of lists are
  // that. None, and nothing is passed over, where it is something else.
  std::optional<double> take_list_value();
  // Text from this token to the last one that was passed over, as it is written.
  [[nodiscard]] std::string_view text_since(const Token& first) const;
  // The SCRIPT comments before the token since the last clear(), in order.
  [[nodiscard]] std::vector<ScriptComment>& scripts() { return scripts_; }

 private:
  void skip_header();
  void skip_blanks();
  void skip_comment();
  void new_line();
  void read_word();
  void read_number();
  void read_text();
  void read_sign();
  void end_token(std::size_t end);

  std::string_view text_;
  std::size_t offset_ = 0;
  std::size_t line_begin_ = 0;
  std::size_t last_end_ = 0;  // behind the token before
  std::uint32_t line_ = 1;
  bool line_is_fresh_ = true;  // no token in this line yet
  Token token_;
  std::vector<ScriptComment> scripts_;
};

// As people should see it: in quotes, or "the end of the program".
[[nodiscard]] std::string shown(const Token& token);

}  // namespace cellmirror::program::rapid
