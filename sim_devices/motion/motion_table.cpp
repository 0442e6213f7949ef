#include "sim_devices/motion/motion_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "rt_core/base/text.hpp"

namespace cellmirror::sim {
namespace {

struct Field {
  std::string_view text;
  int column;  // from 1
};

// At most kMostJoints + 2 fields, so that a hostile line cannot fill the memory.
std::vector<Field> fields_of(std::string_view line) {
  std::vector<Field> fields;
  std::size_t begin = 0;
  while (fields.size() < kMostJoints + 2) {
    const std::size_t comma = line.find_first_of(",;\t", begin);
    const std::string_view raw = line.substr(begin, comma == std::string_view::npos ? comma : comma - begin);
    fields.push_back({trimmed(raw), static_cast<int>(begin) + 1});
    if (comma == std::string_view::npos) break;
    begin = comma + 1;
  }
  return fields;
}

class TableReader {
 public:
  TableReader(std::string_view file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

  void line(int number, std::string_view text) {
    const std::string_view content = trimmed(text);
    if (content.empty() || content.front() == '#') return;
    const std::vector<Field> fields = fields_of(text);
    if (first_) {
      first_ = false;
      if (!parse_number(fields.front().text)) return;  // the heading
    }
    row(number, fields);
  }

  MotionTable take() {
    if (table_.rows() == 0 && diagnostics_.ok()) {
      diagnostics_.error({std::string(file_)}, "the file has no rows", "write rows of time_s, q1, q2, ...");
    }
    return std::move(table_);
  }

 private:
  void row(int number, const std::vector<Field>& fields) {
    const auto place = [&](int column) { return Place{std::string(file_), number, column}; };
    if (fields.size() < 2 || fields.size() > kMostJoints + 1) {
      diagnostics_.error(place(1), fmt::format("a row has its time and 1 to {} values", kMostJoints));
      return;
    }
    if (table_.joints == 0) table_.joints = fields.size() - 1;
    if (fields.size() - 1 != table_.joints) {
      diagnostics_.error(place(1),
                         fmt::format("{} values, but the first row has {}", fields.size() - 1, table_.joints));
      return;
    }
    if (table_.rows() == kMostRows) {
      if (!too_long_) diagnostics_.error(place(1), fmt::format("more than {} rows", kMostRows), "split the file");
      too_long_ = true;
      return;
    }
    values_.clear();
    for (const Field& field : fields) {
      const std::optional<double> value = parse_number(field.text);
      if (!value || std::abs(*value) > 1e9) {
        diagnostics_.error(place(field.column),
                           fmt::format("'{}' is not a number within 1e9", printable(field.text, 40)));
        return;
      }
      values_.push_back(*value);
    }
    append(place(fields.front().column));
  }

  void append(Place place) {
    const double time = values_.front() - (table_.rows() == 0 ? values_.front() : start_);
    if (table_.rows() == 0) start_ = values_.front();
    if (table_.rows() > 0 && time <= table_.time_s.back()) {
      diagnostics_.error(std::move(place), "times must increase from row to row");
      return;
    }
    table_.time_s.push_back(time);
    table_.position.insert(table_.position.end(), values_.begin() + 1, values_.end());
  }

  std::string_view file_;
  Diagnostics& diagnostics_;
  MotionTable table_;
  std::vector<double> values_;
  double start_ = 0;
  bool first_ = true;
  bool too_long_ = false;
};

}  // namespace

MotionTable read_motion_table(std::string_view text, std::string_view file, Diagnostics& diagnostics) {
  TableReader reader(file, diagnostics);
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    reader.line(++number, text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  }
  return reader.take();
}

}  // namespace cellmirror::sim
