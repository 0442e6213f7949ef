#include "scripts/programs/crcl/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <vector>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::crcl {
namespace {

constexpr std::size_t kMostNames = 16;  // that an element may hold

Place place(const std::string& file, const XmlNode& at) {
  return {.file = file, .line = static_cast<int>(at.line), .column = static_cast<int>(at.column)};
}

}  // namespace

double Units::rad() const { return angle == AngleUnit::degree ? kRadPerDeg : 1; }

double Units::metres() const {
  if (length == LengthUnit::inch) return 0.0254;
  return length == LengthUnit::millimetre ? kMPerMm : 1;
}

void Fields::error(const XmlNode& at, std::string message, std::string remedy) const {
  diagnostics_.error(place(file_, at), std::move(message), std::move(remedy));
}

void Fields::warning(const XmlNode& at, std::string message, std::string remedy) const {
  diagnostics_.warning(place(file_, at), std::move(message), std::move(remedy));
}

void Fields::only(const XmlNode& node, std::initializer_list<std::string_view> names, std::string_view repeated) const {
  std::bitset<kMostNames> seen;  // each of the names, and Name behind them
  CELLMIRROR_EXPECTS(names.size() < seen.size());
  for (const XmlNode* one = tree_.first(node); one != nullptr; one = tree_.next(*one)) {
    const auto is_it = [&](std::string_view name) { return same_name(one->name, name); };
    const auto index = static_cast<std::size_t>(std::find_if(names.begin(), names.end(), is_it) - names.begin());
    if (index == names.size() && !is_it("Name")) {
      const std::vector<std::string> candidates(names.begin(), names.end());
      error(*one, fmt::format("<{}> does not belong here", printable(one->name)), did_you_mean(one->name, candidates));
    } else if (seen[index] && !is_it(repeated)) {
      error(*one, fmt::format("<{}> is given twice", one->name));
    } else {
      seen[index] = true;
    }
  }
}

const XmlNode* Fields::required(const XmlNode& node, std::string_view name) const {
  const XmlNode* found = tree_.child(node, name);
  if (found == nullptr) error(node, fmt::format("<{}> is missing in <{}>", name, printable(node.name)));
  return found;
}

std::optional<double> Fields::number(const XmlNode& node) const {
  const auto value = parse_number(node.text);
  if (!value) error(node, fmt::format("<{}> is a number, not '{}'", node.name, printable(node.text)));
  return value;
}

std::optional<long long> Fields::positive_integer(const XmlNode& node) const {
  const auto value = parse_integer(node.text);
  if (value && *value > 0) return value;
  error(node, fmt::format("<{}> is a whole number above 0, not '{}'", node.name, printable(node.text)));
  return std::nullopt;
}

std::optional<bool> Fields::boolean(const XmlNode& node) const {
  if (node.text == "true" || node.text == "1") return true;
  if (node.text == "false" || node.text == "0") return false;
  error(node, fmt::format("<{}> is true or false, not '{}'", node.name, printable(node.text)));
  return std::nullopt;
}

std::optional<double> Fields::fraction(const XmlNode& node) const {
  const auto value = number(node);
  if (!value || (*value >= 0 && *value <= 1)) return value;
  error(node, fmt::format("<{}> is within 0 .. 1, not {}", node.name, *value));
  return std::nullopt;
}

std::optional<double> Fields::number(const XmlNode& node, std::string_view name) const {
  const XmlNode* field = required(node, name);
  return field == nullptr ? std::nullopt : number(*field);
}

std::optional<long long> Fields::positive_integer(const XmlNode& node, std::string_view name) const {
  const XmlNode* field = required(node, name);
  return field == nullptr ? std::nullopt : positive_integer(*field);
}

std::optional<bool> Fields::boolean(const XmlNode& node, std::string_view name) const {
  const XmlNode* field = required(node, name);
  return field == nullptr ? std::nullopt : boolean(*field);
}

std::optional<Eigen::Vector3d> Fields::vector(const XmlNode& node, std::string_view name,
                                              std::initializer_list<std::string_view> components) const {
  const XmlNode* field = required(node, name);
  if (field == nullptr) return std::nullopt;
  only(*field, components);
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  bool complete = true;
  Eigen::Index index = 0;
  for (const std::string_view component : components) {
    const auto value = number(*field, component);
    complete = complete && value.has_value();
    out[index++] = value.value_or(0);
  }
  if (!complete) return std::nullopt;
  return out;
}

std::optional<Pose> Fields::pose(const XmlNode& node, const Units& units) const {
  const auto point = vector(node, "Point", {"X", "Y", "Z"});
  const auto x_axis = vector(node, "XAxis", {"I", "J", "K"});
  const auto z_axis = vector(node, "ZAxis", {"I", "J", "K"});
  if (!point || !x_axis || !z_axis) return std::nullopt;
  constexpr double kShortest = 1e-6;
  const double x_length = x_axis->norm();
  const double z_length = z_axis->norm();
  if (!(x_length > kShortest && z_length > kShortest && std::isfinite(x_length) && std::isfinite(z_length))) {
    error(node, "an axis of the pose has length zero");
    return std::nullopt;
  }
  const Eigen::Vector3d z = *z_axis / z_length;
  const Eigen::Vector3d x_given = *x_axis / x_length;
  // Axes written with few digits are not quite perpendicular; what is further off is a mistake.
  constexpr double kMostOff = 0.02;
  if (std::abs(x_given.dot(z)) > kMostOff) {
    error(node, fmt::format("XAxis and ZAxis are {:.1f} degrees apart, not 90",
                            deg_from_rad(std::acos(std::clamp(x_given.dot(z), -1.0, 1.0)))));
    return std::nullopt;
  }
  const Eigen::Vector3d x = (x_given - x_given.dot(z) * z).normalized();
  Pose X = Pose::Identity();
  X.linear().col(0) = x;
  X.linear().col(1) = z.cross(x);
  X.linear().col(2) = z;
  X.translation() = *point * units.metres();
  return X;
}

}  // namespace cellmirror::crcl
