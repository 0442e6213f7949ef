#include "rt_core/volume/user_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace cellmirror::volume {

namespace {

constexpr std::size_t kFields = 5;
constexpr double kLargestValue = 1e9;
constexpr std::string_view kBlanks = " \t\r\f\v";

struct Fields {
  std::array<std::string_view, kFields> text;
  std::size_t count = 0;  // of those in the line, also beyond kFields
};

Fields fields_of(std::string_view line) {
  Fields fields;
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return fields;
    line.remove_prefix(begin);
    const std::size_t length = std::min(line.find_first_of(kBlanks), line.size());
    if (fields.count < kFields) fields.text[fields.count] = line.substr(0, length);
    ++fields.count;
    line.remove_prefix(length);
  }
}

bool number_of(std::string_view text, double& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(number);
}

// A part of the text as a message shows it.
std::string shown(std::string_view text) {
  static constexpr std::size_t kLongest = 40;
  std::string out;
  for (const char c : text.substr(0, kLongest)) out += c >= ' ' && c < '\x7f' ? c : '?';
  return out;
}

class UserTableReader {
 public:
  UserTableReader(std::string_view file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

  void read_line(std::string_view line) {
    ++line_;
    const Fields fields = fields_of(line.substr(0, line.find('#')));
    if (fields.count == 0) return;
    if (fields.count != kFields)
      return error("a row has " + std::to_string(fields.count) + " numbers instead of 5",
                   "write: value red green blue opacity");
    std::array<double, kFields> numbers{};
    for (std::size_t i = 0; i < kFields; ++i) {
      if (!number_of(fields.text[i], numbers[i]))
        return error("'" + shown(fields.text[i]) + "' is no number", "write: value red green blue opacity");
    }
    add(numbers);
  }

  std::optional<VolumeUserTable> finish() {
    if (table_.rows.size() < 2 && diagnostics_.errors() == errors_before_) {
      line_ = 0;
      error("a table has at least 2 rows", "write rows: value red green blue opacity");
    }
    if (diagnostics_.errors() != errors_before_) return std::nullopt;
    return std::move(table_);
  }

  void error(std::string message, std::string remedy) {
    diagnostics_.error({.file = file_, .line = line_, .column = 0}, std::move(message), std::move(remedy));
  }

 private:
  void add(const std::array<double, kFields>& numbers) {
    if (std::abs(numbers[0]) > kLargestValue) return error("the value is beyond +-1e9", "use the volume's own unit");
    if (std::any_of(numbers.begin() + 1, numbers.end(), [](double part) { return part < 0 || part > 1; }))
      return error("red, green, blue and opacity are from 0 to 1", "divide colours of 0 to 255 by 255");
    if (!table_.rows.empty() && !(numbers[0] > table_.rows.back().value))
      return error("the value is not above that of the row before", "order the rows by rising value");
    if (table_.rows.size() == kMostUserRows)
      return error("more than " + std::to_string(kMostUserRows) + " rows", "leave out rows: they are interpolated");
    const auto part = [&](std::size_t i) { return static_cast<float>(numbers[i]); };
    table_.rows.push_back({.value = numbers[0], .rgb = {part(1), part(2), part(3)}, .opacity = part(4)});
  }

  std::string file_;
  Diagnostics& diagnostics_;
  std::size_t errors_before_ = diagnostics_.errors();
  VolumeUserTable table_;
  int line_ = 0;
};

}  // namespace

std::optional<VolumeUserTable> parse_user_table(std::string_view text, std::string_view file,
                                                Diagnostics& diagnostics) {
  UserTableReader reader(file, diagnostics);
  if (text.size() > kLongestUserTable) {
    reader.error("the table is larger than 1 MiB", "leave out rows: they are interpolated");
    return std::nullopt;
  }
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    reader.read_line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return reader.finish();
}

}  // namespace cellmirror::volume
