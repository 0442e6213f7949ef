#include "app/subcommands/command_texts.hpp"

#include <fmt/format.h>

#include <string_view>

#include "scripts/lang/reader.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kFormatTag = "RBv01r01";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string without_blanks_behind(std::string text) {
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  return text;
}

}  // namespace

void CommandTexts::skip_mark() {
  started_ = true;
  for (const char expected : kByteOrderMark) {
    if (in_.peek() != static_cast<unsigned char>(expected)) return;
    in_.get();
  }
}

void CommandTexts::skip_line() {
  for (char c = 0; in_.get(c) && c != '\n';) {
  }
  ++line_;
}

Result<std::string> CommandTexts::next() {
  if (!started_) skip_mark();
  std::string text;
  for (char c = 0; in_.get(c);) {
    if (at_line_start_ && c == '#') {
      skip_line();
      continue;
    }
    at_line_start_ = c == '\n';
    if (at_line_start_ && line_++ == 1 && without_blanks_behind(text) == kFormatTag) text.clear();
    if (c == ';' && !text.empty()) return without_blanks_behind(std::move(text));
    if (c == ';' || (text.empty() && is_blank(c))) continue;
    if (text.empty()) begin_line_ = line_;
    text += c == '\r' ? ' ' : c;
    if (text.size() > script::kMaxCommandBytes) {
      return fail(fmt::format("line {}: a command of more than {} bytes", begin_line_, script::kMaxCommandBytes),
                  "commands end with ';'");
    }
  }
  if (in_.bad()) return fail("the commands cannot be read to their end");
  return without_blanks_behind(std::move(text));
}

}  // namespace cellmirror::app
