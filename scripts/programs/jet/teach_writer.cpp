#include "scripts/programs/jet/teach_writer.hpp"

#include <fmt/format.h>

#include <cmath>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::program {

namespace {

constexpr double kLeastSpeedShare = 1e-4;  // what the reader takes: 0.01 percent

// Without zeros at the end, and never "-0".
std::string number_text(double value) {
  std::string text = fmt::format("{:.6f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

double in_file_units(JointKind kind, double value) {
  return kind == JointKind::prismatic ? mm_from_m(value) : deg_from_rad(value);
}

std::string tolerance_text(const TeachTolerance& tolerance) {
  switch (tolerance.type) {
    case FlyType::speed_fraction:
      return number_text(100 * tolerance.parameter) + " PERCENT";
    case FlyType::distance:
      return number_text(mm_from_m(tolerance.parameter)) + " MM";
    case FlyType::angle:
      break;
  }
  return number_text(deg_from_rad(tolerance.parameter)) + " DEG";
}

bool is_tolerance(const TeachTolerance& tolerance) {
  const double most = tolerance.type == FlyType::speed_fraction ? 1
                      : tolerance.type == FlyType::distance     ? m_from_mm(kGreatestTeachDistance)
                                                                : rad_from_deg(kGreatestTeachAngle);
  return tolerance.parameter >= 0 && tolerance.parameter <= most;
}

}  // namespace

Result<TeachWriter> TeachWriter::begin(TeachDialect dialect, std::string_view name, std::span<const JointKind> joints) {
  if (!is_teach_name(name))
    return fail(fmt::format("{} is not a valid name of a program", printable(name)),
                fmt::format("a letter, then letters, digits, '_', '-' and '.', at most {}", kMaxNameLength));
  if (joints.empty() || joints.size() > kMaxJointsPerRobot)
    return fail(fmt::format("a teach file is for 1 to {} joints, not for {}", kMaxJointsPerRobot, joints.size()));
  TeachWriter writer(dialect, joints);
  writer.text_ = fmt::format("{} {}\nNAME {}\nJOINTS {}\n", header_of(dialect), kTeachVersion, name, joints.size());
  return writer;
}

void TeachWriter::comment(std::string_view text) {
  constexpr std::size_t kLongest = 200;
  text_ += "# ";
  for (const char c : text.substr(0, kLongest)) text_ += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  text_ += '\n';
}

Result<void> TeachWriter::add(const CheckPoint& point) {
  if (!is_teach_name(point.name))
    return fail(fmt::format("{} is not a valid name of a check point", printable(point.name)));
  if (knows(point.name)) return fail(fmt::format("there is a check point {} already", point.name));
  if (points() == kMostPoints) return fail(fmt::format("a teach file is written with at most {} points", kMostPoints));
  if (point.speed && !(*point.speed >= kLeastSpeedShare && *point.speed <= 1))
    return fail(fmt::format("the speed {} is not within {} .. 1", *point.speed, kLeastSpeedShare));
  if (point.tolerance && !is_tolerance(*point.tolerance))
    return fail(fmt::format("the tolerance {} is too great or negative", point.tolerance->parameter));
  std::vector<std::string> values;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double value = in_file_units(joints_[i], point.joints[i]);
    if (!(std::abs(value) <= kGreatestTeachValue))
      return fail(fmt::format("joint {} is at {}, which is not valid in a teach file", i + 1, value));
    values.push_back(number_text(value));
  }
  text_ += "POINT " + point.name;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (dialect_ == TeachDialect::boom) {
      text_ += " " + values[i];
    } else if (last_values_.empty() || values[i] != last_values_[i]) {
      text_ += fmt::format(" J{}={}", i + 1, values[i]);
    }
  }
  if (point.speed) text_ += " SPEED " + number_text(100 * *point.speed);
  if (point.tolerance) text_ += " TOLERANCE " + tolerance_text(*point.tolerance);
  text_ += '\n';
  names_.insert(point.name);
  last_values_ = std::move(values);
  return {};
}

}  // namespace cellmirror::program
