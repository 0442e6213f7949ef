#include "config/target_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr std::array<std::string_view, 7> kColumns = {"px", "py", "pz", "qx", "qy", "qz", "qw"};
constexpr std::size_t kFirstOfQuaternion = 3;

struct Field {
  std::string_view text;  // without the blanks around it
  int column = 1;
};

// The text up to the next line feed, which `text` loses; without a carriage return at its end.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

class TargetReader {
 public:
  TargetReader(const std::string& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

  std::vector<Pose> read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    if (trimmed(text).empty()) {
      error(0, 0, "the file is empty", expected());
      return {};
    }
    for (bool first = true; !text.empty(); first = false) {
      ++line_;
      const std::string_view line = take_line(text);
      if (first && read_header(line)) continue;
      if (!read_line(line)) break;
    }
    if (targets_.empty() && diagnostics_.ok()) error(0, 0, "there is no target below the header", expected());
    return std::move(targets_);
  }

 private:
  static std::string expected() {
    return fmt::format("expected: the header {}, then one row of seven numbers per target", kTargetHeader);
  }

  void error(int line, int column, std::string message, std::string remedy = {}) {
    diagnostics_.error({file_, line, column}, std::move(message), std::move(remedy));
  }

  // The fields of a line: the first eight at most, and how many there are.
  std::size_t split(std::string_view line) {
    std::size_t count = 0;
    std::size_t begin = 0;
    for (;;) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      if (count < fields_.size()) {
        const std::string_view text = line.substr(begin, end - begin);
        const std::size_t blanks = std::min(text.find_first_not_of(" \t"), text.size());
        fields_[count] = {trimmed(text), static_cast<int>(begin + blanks) + 1};
      }
      ++count;
      if (end == line.size()) return count;
      begin = end + 1;
    }
  }

  // Whether the line looks like a header; a row of numbers does not.
  bool read_header(std::string_view line) {
    const std::size_t count = split(line);
    bool same = count == kColumns.size();
    for (std::size_t i = 0; same && i < kColumns.size(); ++i) same = equal_ignoring_case(fields_[i].text, kColumns[i]);
    if (same) return true;
    const bool row = parse_number(fields_[0].text).has_value();
    const std::string found = row ? "there is no header" : "this is not the header: " + printable(line);
    error(line_, 1, found, fmt::format("the first line must be {}", kTargetHeader));
    return !row;
  }

  // False where reading on makes no sense.
  bool read_line(std::string_view line) {
    if (trimmed(line).empty()) {
      if (blank_line_ == 0) blank_line_ = line_;
      return true;
    }
    if (blank_line_ != 0) {
      error(blank_line_, 1, "a blank line between the rows", "remove it: solutions are numbered by rows");
      blank_line_ = 0;
    }
    if (targets_.size() == kMaxTargets) {
      error(line_, 1, fmt::format("more than {} targets", kMaxTargets), "split the file");
      return false;
    }
    read_row(line);
    return true;
  }

  void read_row(std::string_view line) {
    const std::size_t count = split(line);
    if (count != kColumns.size()) {
      const bool more = count > kColumns.size();
      const int column = more ? fields_[kColumns.size()].column : static_cast<int>(line.size()) + 1;
      return error(line_, column, fmt::format("{} columns, {} are expected", count, kColumns.size()),
                   fmt::format("the columns are {}", kTargetHeader));
    }
    std::array<double, kColumns.size()> values{};
    bool good = true;
    for (std::size_t i = 0; i < kColumns.size(); ++i) good = read_field(i, values[i]) && good;
    if (!good) return;
    const Eigen::Quaterniond q(values[6], values[3], values[4], values[5]);
    if (!(std::abs(q.norm() - 1.0) <= kQuaternionSlack)) {
      return error(line_, fields_[kFirstOfQuaternion].column,
                   fmt::format("the quaternion's norm is {:.6g}, not 1", q.norm()),
                   fmt::format("divide it by its norm; deviations up to {:g} are normalised", kQuaternionSlack));
    }
    Pose X_BG = Pose::Identity();
    X_BG.translation() = Eigen::Vector3d(values[0], values[1], values[2]);
    X_BG.linear() = q.normalized().toRotationMatrix();
    targets_.push_back(X_BG);
  }

  bool read_field(std::size_t i, double& value) {
    const Field& field = fields_[i];
    if (field.text.empty()) {
      error(line_, field.column, fmt::format("{} is empty", kColumns[i]));
      return false;
    }
    const auto number = parse_number(field.text);
    if (!number) {
      error(line_, field.column, fmt::format("{} is not a finite number: {}", kColumns[i], printable(field.text, 40)));
      return false;
    }
    if (i < kFirstOfQuaternion && std::abs(*number) > kFarthestTarget) {
      error(line_, field.column, fmt::format("{} is {:g} m away", kColumns[i], *number),
            fmt::format("targets must be within {:g} m", kFarthestTarget));
      return false;
    }
    value = *number;
    return true;
  }

  const std::string& file_;
  Diagnostics& diagnostics_;
  std::array<Field, kColumns.size() + 1> fields_{};
  std::vector<Pose> targets_;
  int line_ = 0;
  int blank_line_ = 0;  // the first of the blank lines just before this one; 0: none
};

}  // namespace

std::optional<std::vector<Pose>> parse_targets(std::string_view text, const std::string& file,
                                               Diagnostics& diagnostics) {
  Diagnostics found;
  if (text.size() > kLargestTargetFile) {
    diagnostics.error({file}, fmt::format("{} bytes; at most {} are allowed", text.size(), kLargestTargetFile));
    return std::nullopt;
  }
  std::vector<Pose> targets = TargetReader(file, found).read(text);
  diagnostics.take(found);
  if (!found.ok()) return std::nullopt;
  return targets;
}

}  // namespace cellmirror
