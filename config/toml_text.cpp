// From text to a TOML table, whatever the text is.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "config/table_reader.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

// The line of the first table header without a name; 0: none.
int line_of_faulty_header(std::string_view text) {
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.starts_with('[')) continue;
    line = trimmed(line.substr(line.starts_with("[[") ? 2 : 1));
    constexpr std::string_view kFirst = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-\"'";
    if (line.empty() || kFirst.find(line.front()) == std::string_view::npos) return number;
  }
  return 0;
}

// Steps over a string or comment that begins at `at`; elsewhere over one byte.
std::size_t step_over(std::string_view text, std::size_t at) {
  const char c = text[at];
  if (c == '#') return std::min(text.find('\n', at), text.size());
  if (c != '"' && c != '\'') return at + 1;
  const std::string three(3, c);
  if (text.substr(at, 3) == three) {
    for (std::size_t i = at + 3; i < text.size(); ++i) {
      if (text.substr(i, 3) == three) return i + 3;
      // In double quotes the parser skips blanks after a line that ends in a backslash.
      if (c == '"' && static_cast<unsigned char>(text[i]) >= 0x80) return i;
      if (c == '"' && text[i] == '\\') ++i;
    }
    return text.size();
  }
  for (std::size_t i = at + 1; i < text.size(); ++i) {
    if (text[i] == '\n') return i;
    if (text[i] == c) return i + 1;
    if (c == '"' && text[i] == '\\') ++i;
  }
  return text.size();
}

// Whether a quote begins a text for the parser. It does not within what it holds for a number or date, which it reads
// up to the next blank or ',', ']', '}', '#': 33["a" and 10='a' are one.
class WordBefore {
 public:
  [[nodiscard]] bool lets_text_begin() const {
    return is_empty_ || only_brackets_ || (ends_with_dot_ && !equals_on_line_);
  }
  void add(char c) {
    const bool is_word = c == '=' && equals_on_line_ && !is_empty_ && !begins_with_letter_;
    if (c == '\n') equals_on_line_ = false;
    if (c == '=') equals_on_line_ = true;
    constexpr std::string_view kEnds = " \t\r\n,]}#=";
    if (kEnds.find(c) != std::string_view::npos && !is_word) {
      *this = after_end(equals_on_line_);
      return;
    }
    const bool is_bracket = c == '[' || c == '{';
    if (only_brackets_ && !is_bracket)
      begins_with_letter_ = c == '_' || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    is_empty_ = false;
    only_brackets_ = only_brackets_ && is_bracket;
    ends_with_dot_ = c == '.';
  }

 private:
  static WordBefore after_end(bool equals_on_line) {
    WordBefore word;
    word.equals_on_line_ = equals_on_line;
    return word;
  }

  bool is_empty_ = true;
  bool only_brackets_ = true;
  bool begins_with_letter_ = false;
  bool ends_with_dot_ = false;
  bool equals_on_line_ = false;
};

// Counts the parts of a dotted key by the dots since the last separator of keys or values. A number has at most one
// dot.
class KeyParts {
 public:
  static constexpr int kMost = 32;

  // False: the key has more than kMost parts.
  [[nodiscard]] bool add(char c) {
    constexpr std::string_view kSeparators = "\n=,[]{}";
    if (kSeparators.find(c) != std::string_view::npos) dots_ = 0;
    if (c == '.') ++dots_;
    return dots_ < kMost;
  }

 private:
  int dots_ = 0;
};

struct Unreadable {
  std::size_t at = 0;  // byte
  std::string what;
  std::string remedy;
};

// Finds text that must not reach toml++ 3.3. Outside of strings and comments TOML is ASCII: some other characters cause
// undefined behaviour in toml++. Each part of a dotted key becomes a nested table, which toml++ destroys recursively: a
// key with 160,000 parts overflows the stack.
std::optional<Unreadable> find_unreadable(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::size_t at = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  WordBefore word;
  KeyParts key;
  while (at < text.size()) {
    if (static_cast<unsigned char>(text[at]) >= 0x80) {
      return Unreadable{at, "a character outside ASCII is outside a string or comment",
                        "write it in a quoted string on one line; the rest of the file was not read"};
    }
    const char c = text[at];
    if (!key.add(c)) {
      return Unreadable{at,
                        fmt::format("a key has more than {} parts between dots; at most {} are read", KeyParts::kMost,
                                    KeyParts::kMost),
                        "nest fewer tables, or quote a name that contains dots; the rest of the file was not read"};
    }
    const bool is_quote = c == '"' || c == '\'';
    at = is_quote && !word.lets_text_begin() ? at + 1 : step_over(text, at);
    word.add(c);
  }
  return std::nullopt;
}

Place place_of(std::string_view text, std::size_t at, const std::string& file) {
  const std::string_view before = text.substr(0, at);
  const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return {file, static_cast<int>(std::ranges::count(before, '\n')) + 1, static_cast<int>(at - line_start) + 1};
}

}  // namespace

std::optional<toml::table> parse_toml(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  if (text.find('\0') != std::string_view::npos) {
    diagnostics.error({file, 0, 0}, "the file contains NUL bytes and is not TOML");
    return std::nullopt;
  }
  if (const auto found = find_unreadable(text)) {
    diagnostics.error(place_of(text, found->at, file), found->what, found->remedy);
    return std::nullopt;
  }
  const auto refuse = [&](Place place, std::string_view what) {
    diagnostics.error(std::move(place), printable(what, 300), "the rest of the file was not read");
    return std::nullopt;
  };
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    // The parser's message names its macro; users need the limit.
    const bool too_deep = error.description().find("TOML_MAX_NESTED_VALUES") != std::string_view::npos;
    return refuse({file, static_cast<int>(error.source().begin.line), static_cast<int>(error.source().begin.column)},
                  too_deep ? fmt::format("lists and tables are nested more than {} deep; at most {} levels are read",
                                         kMostNestedValues, kMostNestedValues)
                           : std::string(error.description()));
  } catch (const std::exception&) {
    // One of the parser's own checks: it does not check whether a table header begins with a name.
    return refuse({file, line_of_faulty_header(text), 0}, "the text is not TOML: a name was expected");
  }
}

}  // namespace cellmirror
