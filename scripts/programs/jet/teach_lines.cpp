#include "scripts/programs/jet/teach_lines.hpp"

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror::program {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

// Beyond ASCII everything is taken: comments may be in any language, and names and numbers are checked by themselves.
bool is_control(char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f; }

int column_of(std::size_t offset) { return static_cast<int>(offset) + 1; }

}  // namespace

TeachLines::TeachLines(std::string_view text) : rest_(text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

TeachLines::Line TeachLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    column_ = 1;
    word_count_ = 0;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.size() > kLongestTeachLine) return Line::too_long;
    const auto control = std::find_if(line.begin(), line.end(), is_control);
    if (control != line.end()) {
      column_ = column_of(static_cast<std::size_t>(control - line.begin()));
      return Line::unwritten;
    }
    const Line kind = split(line);
    if (kind != Line::words || word_count_ > 0) return kind;
  }
  return Line::end;
}

TeachLines::Line TeachLines::split(std::string_view line) {
  std::size_t i = 0;
  for (;;) {
    while (i < line.size() && is_blank(line[i])) ++i;
    if (i == line.size() || line[i] == '#') return Line::words;
    if (line[i] == '%' && word_count_ == 0) {
      column_ = column_of(i);
      script_ = {trimmed(line.substr(i + 1)), column_of(std::min(line.find_first_not_of(" \t", i + 1), line.size()))};
      return Line::script;
    }
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i]) && line[i] != '#') ++i;
    if (word_count_ == kMostWords) {
      column_ = column_of(begin);
      return Line::too_many;
    }
    words_[word_count_++] = {line.substr(begin, i - begin), column_of(begin)};
  }
}

}  // namespace cellmirror::program
