#include "drivers/can/canopen/ini.hpp"

#include <fmt/format.h>

#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr std::size_t kMaxLine = 4096;

class IniReader {
 public:
  IniReader(const std::string& file, Diagnostics& diagnostics) : file_(file), diagnostics_(&diagnostics) {}

  void line(std::string_view text) {
    ++line_;
    constexpr std::string_view kDosEnd = "\x1A";  // end-of-file mark of DOS text files
    const std::string_view content = trimmed(text);
    if (content.empty() || content == kDosEnd) return;
    if (content.front() == ';' || content.front() == '#' || content.starts_with("//")) return;
    const int column = static_cast<int>(content.data() - text.data()) + 1;
    if (content.size() > kMaxLine) {
      warn(0, fmt::format("the line is longer than {} bytes: ignored", kMaxLine));
    } else if (content.front() == '[') {
      section(content, column);
    } else {
      key(content, column);
    }
  }

  IniFile take() { return std::move(sections_); }

 private:
  // No errors: vendors' files contain faulty lines that no cell uses.
  void warn(int column, std::string message) { diagnostics_->warning({file_, line_, column}, std::move(message)); }

  void section(std::string_view content, int column) {
    current_ = nullptr;
    const std::size_t end = content.find(']');
    if (end == std::string_view::npos || end == 1) {
      warn(column, "a section needs a name and ends with ]: its keys are ignored");
      skipping_ = true;
      return;
    }
    const std::string name(trimmed(content.substr(1, end - 1)));
    const auto [found, is_new] = sections_.try_emplace(lower_case(name));
    skipping_ = !is_new;
    if (!is_new) {
      warn(column, fmt::format("the section [{}] appears twice, first in line {}: this one is skipped", printable(name),
                               found->second.line));
      return;
    }
    found->second.name = name;
    found->second.line = line_;
    current_ = &found->second;
  }

  void key(std::string_view content, int column) {
    const std::size_t equals = content.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      warn(column, "the line is neither [section], key=value nor ; comment: ignored");
      return;
    }
    if (current_ == nullptr) {
      if (!skipping_) warn(column, "a key before the first section: ignored");
      return;
    }
    const std::string_view value = trimmed(content.substr(equals + 1));
    const int value_column = column + static_cast<int>(equals) + 1;
    const std::string name = lower_case(trimmed(content.substr(0, equals)));
    if (!current_->values.try_emplace(name, IniValue{std::string(value), line_, value_column}).second) {
      warn(column,
           fmt::format("{} appears twice in [{}]: the first counts", printable(name), printable(current_->name)));
    }
  }

  std::string file_;
  Diagnostics* diagnostics_;
  IniFile sections_;
  IniSection* current_ = nullptr;
  bool skipping_ = false;
  int line_ = 0;
};

}  // namespace

const IniValue* IniSection::find(std::string_view key_in_lower_case) const {
  const auto found = values.find(key_in_lower_case);
  return found == values.end() ? nullptr : &found->second;
}

IniFile parse_ini(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  IniReader reader(file, diagnostics);
  while (!text.empty()) {
    const std::size_t end = text.find_first_of("\r\n");  // LF, CR or CR LF
    reader.line(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size()
                                                     : end + (text.substr(end).starts_with("\r\n") ? 2 : 1));
  }
  return reader.take();
}

}  // namespace cellmirror::can
