#include "config/urdf_xml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

std::string about(const tinyxml2::XMLElement& element, std::string message) {
  return fmt::format("<{}>: {}", printable(element.Name(), 40), message);
}

// Accepts the characters that a name in a dotted path may have.
bool is_plain(char c) { return c > ' ' && c < 0x7F && c != '.' && c != ';' && c != '#' && c != '"' && c != '\''; }

}  // namespace

void UrdfXml::error(const tinyxml2::XMLElement& element, std::string message, std::string remedy) const {
  diagnostics_->error({file_, element.GetLineNum(), 0}, about(element, std::move(message)), std::move(remedy));
}

void UrdfXml::warning(const tinyxml2::XMLElement& element, std::string message, std::string remedy) const {
  diagnostics_->warning({file_, element.GetLineNum(), 0}, about(element, std::move(message)), std::move(remedy));
}

std::string UrdfXml::text(const tinyxml2::XMLElement& element, const char* attribute, bool required) const {
  const char* value = element.Attribute(attribute);
  if (value == nullptr && required) error(element, fmt::format("the attribute {} is missing", attribute));
  return value == nullptr ? std::string() : std::string(value);
}

std::optional<std::string> UrdfXml::name(const tinyxml2::XMLElement& element, const char* attribute) const {
  const std::string value = text(element, attribute, true);
  if (element.Attribute(attribute) == nullptr) return std::nullopt;
  const bool plain = std::ranges::all_of(value, is_plain);
  if (!value.empty() && value.size() <= kMaxNameLength && plain) return value;
  error(element, fmt::format("{} \"{}\" is not a valid name in a dotted path", attribute, printable(value)),
        fmt::format("rename it: 1 to {} characters, without blanks, dots, quotes, ; and #", kMaxNameLength));
  return std::nullopt;
}

std::string UrdfXml::robot_name(const tinyxml2::XMLElement& robot) const {
  const std::string given = text(robot, "name", true);
  if (robot.Attribute("name") == nullptr) return "robot";
  std::string plain;
  for (const char c : given.substr(0, kMaxNameLength)) plain += is_plain(c) ? c : '_';
  if (plain.empty()) plain = "robot";
  if (plain != given)
    warning(robot, fmt::format("the name \"{}\" cannot be written in commands", printable(given)),
            fmt::format("the robot is called {}", plain));
  return plain;
}

std::optional<double> UrdfXml::number(const tinyxml2::XMLElement& element, const char* attribute, bool required) const {
  const auto values = numbers(element, attribute, 1, required);
  return values ? std::optional((*values)[0]) : std::nullopt;
}

std::optional<std::vector<double>> UrdfXml::numbers(const tinyxml2::XMLElement& element, const char* attribute,
                                                    std::size_t count, bool required) const {
  const std::string value = text(element, attribute, required);
  if (element.Attribute(attribute) == nullptr) return std::nullopt;
  constexpr double kLargest = 1e9;
  std::vector<double> found;
  std::string_view rest = trimmed(value);
  while (!rest.empty() && found.size() <= count) {
    const std::size_t end = std::min(rest.find_first_of(" \t\r\n"), rest.size());
    const auto number = parse_number(rest.substr(0, end));
    if (!number || std::abs(*number) > kLargest) {
      error(element, fmt::format("{} \"{}\" contains something that is not a number or is too large", attribute,
                                 printable(value)));
      return std::nullopt;
    }
    found.push_back(*number);
    rest = trimmed(rest.substr(end));
  }
  if (found.size() == count) return found;
  error(element,
        fmt::format("{} \"{}\" must have {} number{}", attribute, printable(value), count, count == 1 ? "" : "s"));
  return std::nullopt;
}

Eigen::Vector3d UrdfXml::vector3(const tinyxml2::XMLElement& element, const char* attribute,
                                 const Eigen::Vector3d& fallback) const {
  const auto values = numbers(element, attribute, 3, false);
  return values ? Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]) : fallback;
}

// URDF 1.1.
Pose UrdfXml::turned_pose(const tinyxml2::XMLElement& origin, const Eigen::Vector3d& xyz) const {
  Pose pose = Pose::Identity();
  pose.translation() = xyz;
  if (origin.Attribute("rpy") != nullptr) error(origin, "there are rpy and quat_xyzw", "use one of them");
  const auto numbers_of = numbers(origin, "quat_xyzw", 4, true);
  if (!numbers_of) return pose;
  const auto& q = *numbers_of;
  const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
  constexpr double kShortest = 1e-6;
  if (turn.norm() < kShortest) {
    error(origin, "quat_xyzw has length zero");
    return pose;
  }
  pose.linear() = turn.normalized().toRotationMatrix();
  return pose;
}

Pose UrdfXml::origin(const tinyxml2::XMLElement& parent) const {
  const tinyxml2::XMLElement* origin = parent.FirstChildElement("origin");
  if (origin == nullptr) return Pose::Identity();
  const Eigen::Vector3d xyz = vector3(*origin, "xyz", Eigen::Vector3d::Zero());
  if (origin->Attribute("quat_xyzw") != nullptr) return turned_pose(*origin, xyz);
  const Eigen::Vector3d rpy = vector3(*origin, "rpy", Eigen::Vector3d::Zero());
  return pose_from_xyz_rpy(xyz, rpy);
}

}  // namespace cellmirror
