#include "scripts/programs/rapid/lexer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "rt_core/base/text.hpp"

namespace cellmirror::program::rapid {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool continues_word(char c) { return begins_word(c) || is_digit(c); }

struct SignRow {
  std::string_view text;
  Sign sign;
};
// Longer ones before their beginnings.
constexpr auto kSigns = std::to_array<SignRow>({
    {":=", Sign::becomes},    {"<>", Sign::not_equal}, {"<=", Sign::less_equal}, {">=", Sign::greater_equal},
    {"=", Sign::equal},       {"<", Sign::less},       {">", Sign::greater},     {"+", Sign::plus},
    {"-", Sign::minus},       {"*", Sign::times},      {"/", Sign::divide},      {"(", Sign::open},
    {")", Sign::close},       {"[", Sign::open_list},  {"]", Sign::close_list},  {"{", Sign::open_index},
    {"}", Sign::close_index}, {",", Sign::comma},      {";", Sign::semicolon},   {":", Sign::colon},
    {".", Sign::dot},         {"\\", Sign::backslash},
});

}  // namespace

bool Token::is(std::string_view upper) const { return kind == TokenKind::word && equal_ignoring_case(text, upper); }

Lexer::Lexer(std::string_view text) : text_(text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // UTF-8 byte order mark
  if (text_.starts_with(kMark)) offset_ = line_begin_ = kMark.size();
  skip_header();
  advance();
}

std::string_view Lexer::text_since(const Token& first) const {
  const auto begin = static_cast<std::size_t>(first.text.data() - text_.data());
  return last_end_ > begin ? text_.substr(begin, last_end_ - begin) : std::string_view();
}

void Lexer::new_line() {
  ++offset_;
  ++line_;
  line_begin_ = offset_;
  line_is_fresh_ = true;
}

// A header without an end is left to the parser, which reports it.
void Lexer::skip_header() {
  constexpr std::string_view kFence = "%%%";
  skip_blanks();
  if (text_.substr(offset_, kFence.size()) != kFence) return;
  const std::size_t end = text_.find(kFence, offset_ + kFence.size());
  if (end == std::string_view::npos) return;
  while (offset_ < end) {
    if (text_[offset_] == '\n') {
      new_line();
    } else {
      ++offset_;
    }
  }
  offset_ += kFence.size();
}

void Lexer::skip_blanks() {
  while (offset_ < text_.size()) {
    const char c = text_[offset_];
    if (c == '\n') {
      new_line();
    } else if (c == '!') {
      skip_comment();
    } else if (c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f') {
      ++offset_;
    } else {
      return;
    }
  }
}

// `offset_` is at the exclamation mark; afterwards at the line's end.
void Lexer::skip_comment() {
  const std::size_t end = std::min(text_.find('\n', offset_), text_.size());
  const std::string_view content = trimmed(text_.substr(offset_ + 1, end - offset_ - 1));
  if (content.starts_with('%')) {
    const auto column = static_cast<std::size_t>(content.data() - text_.data()) - line_begin_ + 1;
    scripts_.push_back({trimmed(content.substr(1)), line_, static_cast<std::uint32_t>(column)});
  }
  offset_ = end;
}

void Lexer::end_token(std::size_t end) {
  token_.text = text_.substr(offset_, end - offset_);
  offset_ = end;
}

void Lexer::read_word() {
  std::size_t end = offset_ + 1;
  while (end < text_.size() && continues_word(text_[end])) ++end;
  token_.kind = TokenKind::word;
  end_token(end);
}

void Lexer::read_number() {
  std::size_t end = offset_;
  const auto digits = [&] {
    while (end < text_.size() && is_digit(text_[end])) ++end;
  };
  digits();
  if (end < text_.size() && text_[end] == '.') {
    ++end;
    digits();
  }
  if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
    std::size_t exponent = end + 1;
    if (exponent < text_.size() && (text_[exponent] == '+' || text_[exponent] == '-')) ++exponent;
    if (exponent < text_.size() && is_digit(text_[exponent])) {
      end = exponent;
      digits();
    }
  }
  const bool ends = end == text_.size() || !continues_word(text_[end]);
  while (end < text_.size() && continues_word(text_[end])) ++end;
  end_token(end);
  const auto result = std::from_chars(token_.text.data(), token_.text.data() + token_.text.size(), token_.value);
  const bool good = ends && result.ec == std::errc{} && std::isfinite(token_.value);
  token_.kind = good ? TokenKind::number : TokenKind::bad_number;
}

// A quotation mark within the text is written twice.
void Lexer::read_text() {
  std::size_t end = offset_ + 1;
  token_.kind = TokenKind::bad_text;
  while (end < text_.size() && text_[end] != '\n') {
    if (text_[end] != '"') {
      ++end;
    } else if (end + 1 < text_.size() && text_[end + 1] == '"') {
      end += 2;
    } else {
      token_.kind = TokenKind::text;
      ++end;
      break;
    }
  }
  end_token(end);
}

void Lexer::read_sign() {
  const std::string_view rest = text_.substr(offset_);
  const auto* const row = std::ranges::find_if(kSigns, [&](const SignRow& one) { return rest.starts_with(one.text); });
  if (row == kSigns.end()) {
    token_.kind = TokenKind::bad_byte;
    return end_token(offset_ + 1);
  }
  token_.kind = TokenKind::sign;
  token_.sign = row->sign;
  end_token(offset_ + row->text.size());
}

std::optional<double> Lexer::take_list_value() {
  if (token_.kind != TokenKind::number && token_.sign != Sign::minus) return std::nullopt;
  const char* const begin = token_.text.data();
  const char* const last = text_.data() + text_.size();
  double value = 0;
  const auto result = std::from_chars(begin, last, value);
  if (result.ec != std::errc{} || !std::isfinite(value)) return std::nullopt;
  const char* end = result.ptr;
  while (end < last && (*end == ' ' || *end == '\t')) ++end;
  if (end == last || (*end != ',' && *end != ']')) return std::nullopt;
  offset_ = static_cast<std::size_t>(end - text_.data());
  advance();
  return value;
}

void Lexer::advance() {
  last_end_ = offset_;
  skip_blanks();
  token_.sign = Sign::none;
  token_.line = line_;
  token_.column = static_cast<std::uint32_t>(offset_ - line_begin_) + 1;
  token_.begins_line = line_is_fresh_;
  line_is_fresh_ = false;
  if (offset_ >= text_.size()) {
    token_.kind = TokenKind::end_of_text;
    token_.text = text_.substr(text_.size());
    return;
  }
  const char c = text_[offset_];
  const bool fraction = c == '.' && offset_ + 1 < text_.size() && is_digit(text_[offset_ + 1]);
  if (begins_word(c)) return read_word();
  if (is_digit(c) || fraction) return read_number();
  if (c == '"') return read_text();
  read_sign();
}

std::string shown(const Token& token) {
  if (token.kind == TokenKind::end_of_text) return "the end of the program";
  return fmt::format("'{}'", printable(token.text, 40));
}

}  // namespace cellmirror::program::rapid
