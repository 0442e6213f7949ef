#include "scripts/lang/lexer.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "rt_core/base/text.hpp"

namespace cellmirror::script {

namespace {

enum class ByteClass : std::uint8_t { plain, other, blank, line_end, comma, terminator };

constexpr std::array<ByteClass, 256> classify_bytes() {
  std::array<ByteClass, 256> classes{};
  for (std::size_t byte = 0; byte < 256; ++byte)
    classes[byte] = byte > 0x20 && byte < 0x7f ? ByteClass::plain : ByteClass::other;
  for (const char c : {' ', '\t', '\r', '\v', '\f'}) classes[static_cast<unsigned char>(c)] = ByteClass::blank;
  classes['\n'] = ByteClass::line_end;
  classes[','] = ByteClass::comma;
  classes[';'] = ByteClass::terminator;
  return classes;
}

constexpr std::array<ByteClass, 256> kClasses = classify_bytes();

ByteClass class_of(char c) { return kClasses[static_cast<unsigned char>(c)]; }

}  // namespace

void Lexer::skip_blank() {
  while (offset_ < text_.size()) {
    const char c = text_[offset_];
    const ByteClass kind = class_of(c);
    if (kind == ByteClass::line_end) {
      ++offset_;
      new_line();
    } else if (kind == ByteClass::blank) {
      ++offset_;
    } else if (c == '#' && offset_ == line_start_) {
      passed_comment_ = true;
      const void* end = std::memchr(text_.data() + offset_, '\n', text_.size() - offset_);
      offset_ = end == nullptr ? text_.size() : static_cast<std::size_t>(static_cast<const char*>(end) - text_.data());
    } else {
      return;
    }
  }
}

bool Lexer::word(Token& token) {
  commas_ = 0;
  for (;;) {
    skip_blank();
    if (at_end()) return false;
    const ByteClass kind = class_of(text_[offset_]);
    if (kind == ByteClass::terminator) return false;
    if (kind != ByteClass::comma) break;
    ++commas_;
    ++offset_;
  }
  token.begin = position();
  token.commas_before = static_cast<std::uint8_t>(std::min<std::size_t>(commas_, 255));
  token.first_in_line = line_ != word_line_;
  token.plain = true;
  word_line_ = line_;
  const std::size_t begin = offset_;
  for (; offset_ < text_.size(); ++offset_) {
    const ByteClass kind = class_of(text_[offset_]);
    if (kind == ByteClass::plain) continue;
    if (kind != ByteClass::other) break;
    token.plain = false;
  }
  token.text = text_.substr(begin, offset_ - begin);
  commas_ = 0;
  return true;
}

std::string_view Lexer::rest_of_command() {
  skip_blank();
  const std::size_t begin = offset_;
  skip_command();
  std::size_t end = offset_;
  if (end > begin && text_[end - 1] == ';') {
    --offset_;  // the terminator is left for the caller, as word() does
    --end;
  }
  return trimmed(text_.substr(begin, end - begin));
}

std::string_view Lexer::rest_of_text() {
  skip_blank();
  std::string_view rest = trimmed(text_.substr(offset_));
  if (rest.ends_with(';')) rest = trimmed(rest.substr(0, rest.size() - 1));
  while (!at_end()) skip_command();
  return rest;
}

void Lexer::skip_command() {
  for (;;) {
    skip_blank();
    if (at_end()) return;
    if (text_[offset_++] == ';') return;
  }
}

void Lexer::skip_file_header() {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  constexpr std::string_view kFormatTag = "RBv01r01";
  if (text_.starts_with(kByteOrderMark)) {
    offset_ = kByteOrderMark.size();
    line_start_ = offset_;
  }
  const std::size_t line_end = std::min(text_.find('\n', offset_), text_.size());
  if (equal_ignoring_case(trimmed(text_.substr(offset_, line_end - offset_)), kFormatTag)) offset_ = line_end;
}

std::string joined_lines(std::string_view raw) {
  std::string out;
  bool first = true;
  while (!raw.empty() || first) {
    const std::size_t line_end = std::min(raw.find('\n'), raw.size());
    const std::string_view line = raw.substr(0, line_end);
    raw.remove_prefix(std::min(line_end + 1, raw.size()));
    if (!first && line.starts_with('#')) continue;
    const std::string_view content = trimmed(line);
    if (!content.empty()) {
      if (!out.empty()) out += ' ';
      out += content;
    }
    first = false;
  }
  return out;
}

}  // namespace cellmirror::script
