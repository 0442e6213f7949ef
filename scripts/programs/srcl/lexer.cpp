#include "scripts/programs/srcl/lexer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "rt_core/base/text.hpp"

namespace cellmirror::program::srcl {

namespace {

enum class ByteClass : std::uint8_t { bad, blank, line_end, comment, letter, digit, sign };

constexpr std::array<ByteClass, 256> classify_srcl_bytes() {
  std::array<ByteClass, 256> classes{};
  for (const char c : std::string_view(" \t\r\v\f")) classes[static_cast<unsigned char>(c)] = ByteClass::blank;
  classes['\n'] = ByteClass::line_end;
  classes[';'] = ByteClass::comment;
  for (char c = 'a'; c <= 'z'; ++c) classes[static_cast<unsigned char>(c)] = ByteClass::letter;
  for (char c = 'A'; c <= 'Z'; ++c) classes[static_cast<unsigned char>(c)] = ByteClass::letter;
  classes['_'] = ByteClass::letter;
  for (char c = '0'; c <= '9'; ++c) classes[static_cast<unsigned char>(c)] = ByteClass::digit;
  for (const char c : std::string_view("=<>+-*/^(),:.")) classes[static_cast<unsigned char>(c)] = ByteClass::sign;
  return classes;
}

constexpr std::array<ByteClass, 256> kByteClasses = classify_srcl_bytes();

ByteClass class_of_byte(char c) { return kByteClasses[static_cast<unsigned char>(c)]; }

bool continues_word(char c) {
  const ByteClass kind = class_of_byte(c);
  return kind == ByteClass::letter || kind == ByteClass::digit;
}

Sign sign_of(char c) {
  switch (c) {
    case '=':
      return Sign::equal;
    case '<':
      return Sign::less;
    case '>':
      return Sign::greater;
    case '+':
      return Sign::plus;
    case '-':
      return Sign::minus;
    case '*':
      return Sign::times;
    case '/':
      return Sign::divide;
    case '^':
      return Sign::power;
    case '(':
      return Sign::open;
    case ')':
      return Sign::close;
    case ',':
      return Sign::comma;
    case ':':
      return Sign::colon;
    default:
      return Sign::dot;
  }
}

}  // namespace

Lexer::Lexer(std::string_view text) : text_(text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // UTF-8 byte order mark
  if (text_.starts_with(kMark)) offset_ = line_begin_ = kMark.size();
  advance();
}

std::string_view Lexer::text_since(const Token& first) const {
  const auto begin = static_cast<std::size_t>(first.text.data() - text_.data());
  return last_end_ > begin ? text_.substr(begin, last_end_ - begin) : std::string_view();
}

void Lexer::skip_blanks() {
  while (offset_ < text_.size() && class_of_byte(text_[offset_]) == ByteClass::blank) ++offset_;
}

// `offset_` is at the semicolon; afterwards at the line's end.
void Lexer::skip_comment() {
  const std::size_t end = std::min(text_.find('\n', offset_), text_.size());
  const std::string_view content = trimmed(text_.substr(offset_ + 1, end - offset_ - 1));
  if (content.starts_with('%')) {
    const auto column =
        static_cast<std::uint32_t>(content.data() - text_.data() - static_cast<std::ptrdiff_t>(line_begin_)) + 1;
    scripts_.push_back({trimmed(content.substr(1)), line_, column});
  }
  offset_ = end;
}

// Behind a comma: line ends, and comments before them, are nothing.
void Lexer::skip_line_ends() {
  for (;;) {
    skip_blanks();
    if (offset_ >= text_.size()) return;
    const ByteClass kind = class_of_byte(text_[offset_]);
    if (kind == ByteClass::comment) {
      skip_comment();
    } else if (kind == ByteClass::line_end) {
      ++offset_;
      ++line_;
      line_begin_ = offset_;
    } else {
      return;
    }
  }
}

void Lexer::end_token(std::size_t end) {
  token_.text = text_.substr(offset_, end - offset_);
  offset_ = end;
}

void Lexer::read_word() {
  std::size_t end = offset_ + 1;
  while (end < text_.size() && continues_word(text_[end])) ++end;
  end_token(end);
  token_.keyword = find_keyword(token_.text);
  token_.kind = token_.keyword == Keyword::none ? TokenKind::name : TokenKind::keyword;
}

void Lexer::read_number() {
  const auto skip_digits = [this](std::size_t at) {
    while (at < text_.size() && class_of_byte(text_[at]) == ByteClass::digit) ++at;
    return at;
  };
  std::size_t end = skip_digits(offset_);
  bool whole = true;
  if (end < text_.size() && text_[end] == '.') {
    whole = false;
    end = skip_digits(end + 1);
  }
  if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
    std::size_t exponent = end + 1;
    if (exponent < text_.size() && (text_[exponent] == '+' || text_[exponent] == '-')) ++exponent;
    if (exponent < text_.size() && class_of_byte(text_[exponent]) == ByteClass::digit) {
      whole = false;
      end = skip_digits(exponent);
    }
  }
  token_.kind = whole ? TokenKind::integer : TokenKind::real;
  if (end < text_.size() && continues_word(text_[end])) {
    token_.kind = TokenKind::bad_number;
    while (end < text_.size() && continues_word(text_[end])) ++end;
  }
  end_token(end);
  const char* const first = token_.text.data();
  const char* const last = first + token_.text.size();
  if (token_.kind == TokenKind::integer) {
    if (std::from_chars(first, last, token_.integer).ec != std::errc{}) token_.kind = TokenKind::bad_number;
  } else if (token_.kind == TokenKind::real) {
    const auto result = std::from_chars(first, last, token_.real);
    if (result.ec != std::errc{} || result.ptr != last || !std::isfinite(token_.real))
      token_.kind = TokenKind::bad_number;
  }
}

void Lexer::read_sign() {
  const char c = text_[offset_];
  const char following = offset_ + 1 < text_.size() ? text_[offset_ + 1] : '\0';
  if (c == '.' && class_of_byte(following) == ByteClass::digit) return read_number();
  token_.kind = TokenKind::sign;
  token_.sign = sign_of(c);
  std::size_t end = offset_ + 1;
  if ((c == '<' || c == '>') && following == '=') {
    token_.sign = c == '<' ? Sign::less_equal : Sign::greater_equal;
    ++end;
  } else if (c == '<' && following == '>') {
    token_.sign = Sign::not_equal;
    ++end;
  }
  end_token(end);
}

void Lexer::advance() {
  if (token_.kind == TokenKind::end_of_line) {
    ++line_;
    line_begin_ = offset_;
  } else {
    last_end_ = offset_;
    if (token_.sign == Sign::comma) skip_line_ends();
  }
  skip_blanks();
  token_.keyword = Keyword::none;
  token_.sign = Sign::none;
  if (offset_ < text_.size() && class_of_byte(text_[offset_]) == ByteClass::comment) skip_comment();
  token_.line = line_;
  token_.column = static_cast<std::uint32_t>(offset_ - line_begin_) + 1;
  if (offset_ >= text_.size()) {
    token_.kind = TokenKind::end_of_text;
    token_.text = text_.substr(text_.size());
    return;
  }
  switch (class_of_byte(text_[offset_])) {
    case ByteClass::line_end:
      token_.kind = TokenKind::end_of_line;
      end_token(offset_ + 1);
      return;
    case ByteClass::letter:
      return read_word();
    case ByteClass::digit:
      return read_number();
    case ByteClass::sign:
      return read_sign();
    default: {
      std::size_t end = offset_ + 1;
      while (end < text_.size() && class_of_byte(text_[end]) == ByteClass::bad) ++end;
      token_.kind = TokenKind::bad_byte;
      end_token(end);
      return;
    }
  }
}

}  // namespace cellmirror::program::srcl
