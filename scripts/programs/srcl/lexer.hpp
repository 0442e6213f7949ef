// Splits SRCL text into words and signs, one ahead of the parser. Handles lines, comments and continuation lines; no
// grammar. Views point into the text, which must outlive them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "scripts/programs/program/script_comment.hpp"
#include "scripts/programs/srcl/keywords.hpp"

namespace cellmirror::program::srcl {

enum class TokenKind : std::uint8_t {
  end_of_text,
  end_of_line,
  name,
  keyword,
  integer,
  real,
  bad_number,  // begins like a number but is invalid, or out of range
  sign,
  bad_byte,
};

enum class Sign : std::uint8_t {
  none,
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
  power,
  open,
  close,
  comma,
  colon,
  dot,
};

struct Token {
  std::string_view text;
  std::uint32_t line = 1;
  std::uint32_t column = 1;  // in bytes
  TokenKind kind = TokenKind::end_of_text;
  Keyword keyword = Keyword::none;
  Sign sign = Sign::none;
  std::int64_t integer = 0;
  double real = 0;
};

class Lexer {
 public:
  explicit Lexer(std::string_view text);

  [[nodiscard]] const Token& token() const { return token_; }
  // Moves to the next token. After a comma the statement continues on the next line that is not blank.
  void advance();
  [[nodiscard]] bool at_end_of_line() const {
    return token_.kind == TokenKind::end_of_line || token_.kind == TokenKind::end_of_text;
  }
  // Text from this token to the last one that was passed over, as it is written.
  [[nodiscard]] std::string_view text_since(const Token& first) const;
  // The SCRIPT comments that were met since the last clear(), in order; those of a line are there when its end is the
  // token.
  [[nodiscard]] std::vector<ScriptComment>& scripts() { return scripts_; }

 private:
  void skip_blanks();
  void skip_comment();
  void skip_line_ends();
  void read_word();
  void read_number();
  void read_sign();
  void end_token(std::size_t end);

  std::string_view text_;
  std::size_t offset_ = 0;
  std::size_t line_begin_ = 0;
  std::size_t last_end_ = 0;  // behind the token before
  std::uint32_t line_ = 1;
  Token token_;
  std::vector<ScriptComment> scripts_;
};

}  // namespace cellmirror::program::srcl
