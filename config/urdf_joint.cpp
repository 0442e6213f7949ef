#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/urdf_model.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

using tinyxml2::XMLElement;

namespace {

constexpr double kUnlimited = 1e6;  // rad; a continuous joint has no limits
constexpr double kRampTime = 0.2;   // s to full speed: URDF 1.0 gives no acceleration

std::string read_end(const XMLElement& element, const char* tag, const UrdfXml& xml) {
  const XMLElement* end = element.FirstChildElement(tag);
  if (end == nullptr) {
    xml.error(element, fmt::format("there is no <{}>", tag));
    return {};
  }
  return xml.text(*end, "link", true);
}

void read_axis(const XMLElement& element, const UrdfXml& xml, JointDefinition& joint) {
  joint.axis = Eigen::Vector3d::UnitX();  // URDF's own default
  const XMLElement* axis = element.FirstChildElement("axis");
  if (axis == nullptr) return;
  const Eigen::Vector3d direction = xml.vector3(*axis, "xyz", joint.axis);
  constexpr double kShortest = 1e-6;
  if (direction.norm() < kShortest) return xml.error(*axis, "the axis has length zero");
  joint.axis = direction.normalized();
}

void read_mimic(const XMLElement& element, const UrdfXml& xml, JointDefinition& joint) {
  const XMLElement* mimic = element.FirstChildElement("mimic");
  if (mimic == nullptr) return;
  joint.mimic = Mimic{xml.text(*mimic, "joint", true), xml.number(*mimic, "multiplier", false).value_or(1.0),
                      xml.number(*mimic, "offset", false).value_or(0.0)};
}

void read_limit(const XMLElement& element, const UrdfXml& xml, JointDefinition& joint) {
  const XMLElement* limit = element.FirstChildElement("limit");
  const bool limited = joint.kind != JointKind::continuous;
  if (!limited) {
    joint.min_position = -kUnlimited;
    joint.max_position = kUnlimited;
  }
  if (limit == nullptr) {
    if (limited && !joint.mimic) xml.error(element, "a revolute or prismatic joint needs <limit>");
    joint.max_velocity = 1.0;
    joint.max_acceleration = 1.0 / kRampTime;
    return;
  }
  if (limited) {
    joint.min_position = xml.number(*limit, "lower", false).value_or(0.0);
    joint.max_position = xml.number(*limit, "upper", false).value_or(0.0);
    // Equal: the joint has one position, as a machine has that was fixed by hand.
    if (joint.min_position > joint.max_position && !joint.mimic)
      xml.error(*limit, fmt::format("lower {:g} is not below upper {:g}", joint.min_position, joint.max_position));
  }
  joint.max_velocity = xml.number(*limit, "velocity", !joint.mimic.has_value()).value_or(1.0);
  joint.velocity_given = limit->Attribute("velocity") != nullptr && joint.max_velocity > 0.0;
  if (joint.max_velocity <= 0.0) {
    if (!joint.mimic) xml.warning(*limit, "velocity is not positive", "1 rad/s (m/s) is used");
    joint.max_velocity = 1.0;
  }
  joint.max_acceleration = joint.max_velocity / kRampTime;
  joint.drive.max_effort = std::abs(xml.number(*limit, "effort", false).value_or(0.0));
}

// An axis of a robot turns a few times at most, while 90 or 180 is a usual limit in degrees.
void warn_of_degrees(const XMLElement& element, const UrdfXml& xml, const JointDefinition& joint) {
  constexpr double kFurthest = 40.0;  // rad; some axes of wrists turn by 6 turns
  const double furthest = std::max(std::abs(joint.min_position), std::abs(joint.max_position));
  if (joint.kind != JointKind::revolute || joint.mimic || furthest <= kFurthest || furthest >= kUnlimited) return;
  xml.warning(element,
              fmt::format("a limit of {:g} rad is {:.0f} turns", furthest, furthest / (2.0 * std::numbers::pi)),
              "where it is in degrees, write it in radians");
}

}  // namespace

std::optional<UrdfJoint> read_urdf_joint(const XMLElement& element, const UrdfXml& xml) {
  UrdfJoint out;
  const auto name = xml.name(element, "name");
  out.line = element.GetLineNum();
  out.parent = read_end(element, "parent", xml);
  out.child = read_end(element, "child", xml);
  out.X_PJ = xml.origin(element);
  const std::string type = xml.text(element, "type", true);
  if (type == "floating" || type == "planar") {
    xml.warning(element, fmt::format("the joint is of type {}", type), "its child stays at its origin");
  } else if (type != "fixed") {
    JointDefinition joint;
    if (type == "continuous") joint.kind = JointKind::continuous;
    if (type == "prismatic") joint.kind = JointKind::prismatic;
    const bool known = type == "revolute" || type == "continuous" || type == "prismatic";
    if (!known && element.Attribute("type") != nullptr) {
      xml.error(element, fmt::format("joints of type \"{}\" cannot be used", printable(type)),
                "types are revolute, continuous, prismatic and fixed");
    }
    read_axis(element, xml, joint);
    read_mimic(element, xml, joint);
    if (known) read_limit(element, xml, joint);
    if (known) warn_of_degrees(element, xml, joint);
    const bool zero_inside = joint.min_position <= 0.0 && joint.max_position >= 0.0;
    joint.start_position = zero_inside ? 0.0 : 0.5 * (joint.min_position + joint.max_position);
    if (const XMLElement* dynamics = element.FirstChildElement("dynamics")) {
      joint.drive.viscous_friction = xml.number(*dynamics, "damping", false).value_or(0.0);
      joint.drive.coulomb_friction = xml.number(*dynamics, "friction", false).value_or(0.0);
    }
    out.joint = joint;
  }
  if (!name || out.parent.empty() || out.child.empty()) return std::nullopt;
  out.name = *name;
  return out;
}

}  // namespace cellmirror
