#include "config/posture_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr int kMostLines = static_cast<int>(2 * kMaxPostures);  // with comments
// A limit that was written in degrees may differ from the same number in radians by rounding.
constexpr double kRounding = 1e-9;

std::string_view unit_of(JointKind kind) { return kind == JointKind::prismatic ? "m" : "rad"; }

std::string expected() { return "expected: a header of robot.joint columns, then one row of numbers per posture"; }

std::size_t skip_blanks(std::string_view line, std::size_t at) {
  return std::min(line.find_first_not_of(" \t", at), line.size());
}

std::string example_column(const Cell& cell) {
  for (const std::string& id : cell.robot_ids()) {
    const RobotModel* robot = cell.robot(id);
    if (robot != nullptr && robot->joint_count() > 0) return "e.g. " + id + "." + robot->joints().front().name;
  }
  return "the cell has no robot with joints";
}

}  // namespace

PostureReader::PostureReader(std::istream& in, std::string file, const Cell& cell, Diagnostics& diagnostics)
    : in_(in), file_(std::move(file)), cell_(cell), diagnostics_(diagnostics) {}

void PostureReader::error(int column, std::string message, std::string remedy) {
  diagnostics_.error({file_, line_number_, column}, std::move(message), std::move(remedy));
}

// The next line of the file without its end, into `line_`. False: at the end, or if reading has stopped.
bool PostureReader::next_line() {
  if (ended_) return false;
  line_.clear();
  std::streambuf* bytes = in_.rdbuf();
  constexpr int kEnd = std::char_traits<char>::eof();
  int c = bytes == nullptr ? kEnd : bytes->sbumpc();
  if (c == kEnd) {
    ended_ = true;
    return false;
  }
  ++line_number_;
  for (; c != kEnd && c != '\n'; c = bytes->sbumpc()) {
    if (line_.size() == kLongestPostureLine) {
      error(0, fmt::format("the line is longer than {} bytes", kLongestPostureLine), "is it a CSV file?");
      ended_ = true;
      return false;
    }
    line_.push_back(std::char_traits<char>::to_char_type(c));
  }
  if (line_.ends_with('\r')) line_.pop_back();
  if (line_number_ == 1 && line_.starts_with("\xEF\xBB\xBF")) line_.erase(0, 3);
  if (line_number_ <= kMostLines) return true;
  error(0, fmt::format("more than {} lines", kMostLines), "split the file");
  ended_ = true;
  return false;
}

// The same without comments and blank lines. Blank lines between the rows are an error: a row of one empty field looks
// like one, and frames are numbered.
bool PostureReader::next_content_line() {
  while (next_line()) {
    const std::string_view text = trimmed(line_);
    if (text.starts_with('#')) continue;
    if (text.empty()) {
      if (blank_line_ == 0) blank_line_ = line_number_;
      continue;
    }
    if (blank_line_ != 0 && !columns_.empty())
      diagnostics_.error({file_, blank_line_, 1}, "a blank line between the rows",
                         "remove it: frames are numbered by rows");
    blank_line_ = 0;
    return true;
  }
  return false;
}

// The fields of `line_`, kMaxPostureColumns + 1 at most. False, and a finding, where quotes are wrong.
bool PostureReader::split() {
  const std::string_view line = line_;
  field_count_ = 0;
  std::size_t at = 0;
  while (field_count_ <= kMaxPostureColumns) {
    if (field_count_ == fields_.size()) fields_.emplace_back();
    Field& field = fields_[field_count_++];
    at = skip_blanks(line, at);
    field.column = static_cast<int>(at) + 1;
    if (at < line.size() && line[at] == '"') {
      field.text.clear();
      for (++at;; ++at) {
        if (at >= line.size()) {
          error(field.column, "the closing quote is missing");
          return false;
        }
        if (line[at] == '"' && (at + 1 >= line.size() || line[at + 1] != '"')) break;
        if (line[at] == '"') ++at;
        field.text.push_back(line[at]);
      }
      at = skip_blanks(line, at + 1);
      if (at < line.size() && line[at] != ',') {
        error(static_cast<int>(at) + 1, "text after the closing quote: " + printable(line.substr(at), 40));
        return false;
      }
    } else {
      const std::size_t end = std::min(line.find(',', at), line.size());
      field.text.assign(trimmed(line.substr(at, end - at)));
      at = end;
    }
    if (at == line.size()) return true;
    ++at;
  }
  return true;
}

bool PostureReader::find_joint(const std::string& name, Column& column) const {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return false;
  const RobotModel* robot = cell_.robot(std::string_view(name).substr(0, dot));
  if (robot == nullptr) return false;
  const std::string_view joint = std::string_view(name).substr(dot + 1);
  const auto joints = robot->joints();
  const auto found = std::find_if(joints.begin(), joints.end(), [&](const RobotJoint& j) { return j.name == joint; });
  if (found == joints.end()) return false;
  column.slot = robot->slot();
  column.joint = static_cast<std::size_t>(found - joints.begin());
  column.kind = found->kind;
  column.lower = robot->parameters().min_range[column.joint];
  column.upper = robot->parameters().max_range[column.joint];
  return true;
}

Error PostureReader::explain_joint(const std::string& name) const {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return {printable(name) + " is not robot.joint", example_column(cell_)};
  const std::string robot_name = name.substr(0, dot);
  const RobotModel* robot = cell_.robot(robot_name);
  if (robot == nullptr) return cell_.explain_robot(robot_name);
  const std::vector<std::string> joints = robot->joint_names();
  std::string hint = did_you_mean(name.substr(dot + 1), joints);
  if (hint.empty()) {
    for (const std::string& joint : joints) hint += (hint.empty() ? "its joints are " : ", ") + printable(joint);
  }
  return {fmt::format("robot {} has no joint {}", printable(robot_name), printable(name.substr(dot + 1))),
          std::move(hint)};
}

void PostureReader::read_column(const Field& field) {
  Column column;
  column.name = field.text;
  column.header_column = field.column;
  if (field.text.empty()) return error(field.column, "a column without a name", "columns are named robot.joint");
  if (!find_joint(field.text, column)) {
    const Error why = explain_joint(field.text);
    return error(field.column, why.what, why.remedy);
  }
  for (const Column& other : columns_) {
    if (other.slot == column.slot && other.joint == column.joint)
      return error(field.column, fmt::format("{} appears twice", printable(field.text)),
                   fmt::format("first in column {}", other.header_column));
  }
  columns_.push_back(std::move(column));
}

bool PostureReader::read_header() {
  if (!next_content_line()) {
    if (diagnostics_.ok()) diagnostics_.error({file_}, "the file is empty", expected());
    return false;
  }
  if (!split()) return false;
  if (field_count_ > kMaxPostureColumns) {
    error(fields_[kMaxPostureColumns].column, fmt::format("more than {} columns", kMaxPostureColumns));
    return false;
  }
  if (parse_number(fields_[0].text)) {
    error(1, "there is no header", expected());
    return false;
  }
  for (std::size_t i = 0; i < field_count_; ++i) read_column(fields_[i]);
  values_.resize(columns_.size());
  return columns_.size() == field_count_;
}

bool PostureReader::read_value(std::size_t i, double& value) {
  const Field& field = fields_[i];
  const Column& column = columns_[i];
  if (field.text.empty()) {
    error(field.column, printable(column.name) + " is empty");
    return false;
  }
  const auto number = parse_number(field.text);
  if (!number) {
    error(field.column,
          fmt::format("{} is not a finite number: {}", printable(column.name), printable(field.text, 40)));
    return false;
  }
  if (std::abs(*number) > kGreatestJointValue) {
    error(field.column, fmt::format("{} is {:g} {}", printable(column.name), *number, unit_of(column.kind)),
          fmt::format("values must be within {:g}", kGreatestJointValue));
    return false;
  }
  value = *number;
  return true;
}

bool PostureReader::read_row(std::span<JointValues> q) {
  if (!next_content_line()) return false;
  if (rows_ == kMaxPostures) {
    error(0, fmt::format("more than {} postures", kMaxPostures), "split the file");
    ended_ = true;
    return false;
  }
  ++rows_;
  if (!split()) return true;
  if (field_count_ != columns_.size()) {
    const bool more = field_count_ > columns_.size();
    error(more ? fields_[columns_.size()].column : static_cast<int>(line_.size()) + 1,
          fmt::format("{} columns, the header has {}", field_count_, columns_.size()));
    return true;
  }
  bool good = true;
  for (std::size_t i = 0; i < columns_.size(); ++i) good = read_value(i, values_[i]) && good;
  if (!good) return true;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    Column& column = columns_[i];
    q[column.slot][column.joint] = values_[i];
    const bool inside = values_[i] >= column.lower - kRounding && values_[i] <= column.upper + kRounding;
    if (inside || column.kind == JointKind::continuous) continue;
    if (column.beyond++ > 0) continue;
    column.first_line = line_number_;
    column.first_column = fields_[i].column;
    column.first_value = values_[i];
  }
  return true;
}

void PostureReader::finish() {
  if (rows_ == 0 && !columns_.empty() && diagnostics_.ok())
    diagnostics_.error({file_}, "there is no posture below the header", expected());
  for (const Column& column : columns_) {
    if (column.beyond == 0) continue;
    diagnostics_.warning({file_, column.first_line, column.first_column},
                         fmt::format("{} is {:g} {}, beyond its range {:g} .. {:g}{}", printable(column.name),
                                     column.first_value, unit_of(column.kind), column.lower, column.upper,
                                     column.beyond == 1 ? "" : fmt::format("; so in {} rows", column.beyond)),
                         "it is used as given");
  }
}

}  // namespace cellmirror
