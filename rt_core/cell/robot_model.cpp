#include "rt_core/cell/robot_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rt_core/base/units.hpp"

namespace cellmirror {

namespace {

bool is_prismatic(JointKind kind) { return kind == JointKind::prismatic; }

// A value of a joint parameter with its unit, for people.
std::string quantity_text(JointParameter which, JointKind kind, double value) {
  const bool length = is_prismatic(kind);
  switch (which) {
    case JointParameter::max_velocity:
    case JointParameter::min_velocity:
    case JointParameter::active_velocity:
      return fmt::format("{:.6g} {}", value, length ? "m/s" : "rad/s");
    case JointParameter::max_acceleration:
    case JointParameter::active_acceleration:
      return fmt::format("{:.6g} {}", value, length ? "m/s2" : "rad/s2");
    case JointParameter::max_range:
    case JointParameter::min_range:
    case JointParameter::start_position:
    case JointParameter::reference_position:
      break;
  }
  return position_text(kind, value);
}

const char* name_of(JointParameter which) {
  switch (which) {
    case JointParameter::max_range:
      return "upper limit";
    case JointParameter::min_range:
      return "lower limit";
    case JointParameter::start_position:
      return "start position";
    case JointParameter::reference_position:
      return "reference position";
    case JointParameter::max_velocity:
      return "maximum velocity";
    case JointParameter::min_velocity:
      return "minimum velocity";
    case JointParameter::active_velocity:
      return "active velocity";
    case JointParameter::max_acceleration:
      return "maximum acceleration";
    case JointParameter::active_acceleration:
      return "active acceleration";
  }
  return "parameter";
}

// Where the values given for a parameter are kept.
JointValues& values_of(RobotParameters& p, JointParameter which) {
  switch (which) {
    case JointParameter::start_position:
      return p.requested.start_position;
    case JointParameter::active_velocity:
      return p.requested.active_velocity;
    case JointParameter::active_acceleration:
      return p.requested.active_acceleration;
    case JointParameter::max_range:
      return p.max_range;
    case JointParameter::min_range:
      return p.min_range;
    case JointParameter::reference_position:
      return p.reference_position;
    case JointParameter::max_velocity:
      return p.max_velocity;
    case JointParameter::min_velocity:
      return p.min_velocity;
    case JointParameter::max_acceleration:
      return p.max_acceleration;
  }
  return p.max_range;
}

// What a value of joint `i` must satisfy against the parameters in force; empty where it does.
std::string conflict(const RobotParameters& p, JointParameter which, JointKind kind, std::size_t i, double value) {
  const auto text = [&](JointParameter other, double v) {
    return fmt::format("its {} {}", name_of(other), quantity_text(other, kind, v));
  };
  switch (which) {
    case JointParameter::max_range:
      if (!(value > p.min_range[i])) return "is not above " + text(JointParameter::min_range, p.min_range[i]);
      break;
    case JointParameter::min_range:
      if (!(value < p.max_range[i])) return "is not below " + text(JointParameter::max_range, p.max_range[i]);
      break;
    case JointParameter::start_position:
      if (value < p.min_range[i]) return "is below " + text(JointParameter::min_range, p.min_range[i]);
      if (value > p.max_range[i]) return "is above " + text(JointParameter::max_range, p.max_range[i]);
      break;
    case JointParameter::reference_position:
      break;
    case JointParameter::max_velocity:
      if (!(value > 0.0)) return "is not positive";
      if (value < p.min_velocity[i]) return "is below " + text(JointParameter::min_velocity, p.min_velocity[i]);
      break;
    case JointParameter::min_velocity:
      if (value < 0.0) return "is negative";
      if (value > p.max_velocity[i]) return "is above " + text(JointParameter::max_velocity, p.max_velocity[i]);
      break;
    case JointParameter::active_velocity:
      if (!(value > 0.0)) return "is not positive";
      if (value > p.max_velocity[i]) return "is above " + text(JointParameter::max_velocity, p.max_velocity[i]);
      break;
    case JointParameter::max_acceleration:
      if (!(value > 0.0)) return "is not positive";
      break;
    case JointParameter::active_acceleration:
      if (!(value > 0.0)) return "is not positive";
      if (value > p.max_acceleration[i])
        return "is above " + text(JointParameter::max_acceleration, p.max_acceleration[i]);
      break;
  }
  return {};
}

// What to do about such a conflict where that is not in plain sight: the units of SCRIPT, rad/s beside degrees.
std::string remedy(const RobotParameters& p, JointParameter which, JointKind kind, std::size_t i) {
  const bool velocity = which == JointParameter::active_velocity;
  if (!velocity && which != JointParameter::active_acceleration) return {};
  const bool length = is_prismatic(kind);
  const double most = velocity ? p.max_velocity[i] : p.max_acceleration[i];
  constexpr double kSteps = 1000;  // rounded down, so that what is advised is taken
  const double shown = std::floor((length ? mm_from_m(most) : most) * kSteps) / kSteps;
  return fmt::format("in {}{}: give more than 0 and at most {:.10g}, or raise {} first",
                     length ? (velocity ? "mm/s" : "mm/s2") : (velocity ? "rad/s" : "rad/s2"),
                     length ? "" : ", not degrees", shown, velocity ? "rob_jnt_max_vel" : "rob_jnt_max_acc");
}

// What is in force of what was requested.
void apply_limits(RobotParameters& p, std::size_t joints) {
  const RequestedParameters& requested = p.requested;
  for (std::size_t i = 0; i < joints; ++i) {
    p.start_position[i] = std::clamp(requested.start_position[i], p.min_range[i], p.max_range[i]);
    p.active_velocity[i] = std::min(requested.active_velocity[i], p.max_velocity[i]);
    p.active_acceleration[i] = std::min(requested.active_acceleration[i], p.max_acceleration[i]);
  }
}

Result<void> check_pose(const Pose& X, const std::string& robot, const char* name) {
  constexpr double kFarthestTool = 1e3;  // m; a tool is no building
  if (!X.matrix().allFinite()) return fail(fmt::format("the {} of {} has a value that is not a number", name, robot));
  if (X.translation().norm() > kFarthestTool)
    return fail(fmt::format("the {} of {} is {:.6g} m away", name, robot, X.translation().norm()),
                fmt::format("give at most {:g} m", kFarthestTool));
  return {};
}

}  // namespace

std::string position_text(JointKind kind, double value) {
  if (is_prismatic(kind)) return fmt::format("{:.6g} m ({:.6g} mm)", value, mm_from_m(value));
  return fmt::format("{:.6g} rad ({:.6g} deg)", value, deg_from_rad(value));
}

Pose RobotModel::X_FT() const { return parameters_.X_FP * parameters_.X_PT; }

std::vector<std::string> RobotModel::joint_names() const {
  std::vector<std::string> names;
  names.reserve(joints_.size());
  for (const RobotJoint& joint : joints_) names.push_back(joint.name);
  return names;
}

Result<void> RobotModel::set_joint_parameter(JointParameter which, std::span<const double> values) {
  if (values.size() != joints_.size()) {
    return fail(fmt::format("{} has {} joints, but {} values are given for the {}", id_, joints_.size(), values.size(),
                            name_of(which)),
                "give one value per joint, in the order of its component file");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      return fail(fmt::format("the {} of joint {} is not a number", name_of(which), i + 1));
    const std::string reason = conflict(parameters_, which, joints_[i].kind, i, values[i]);
    if (!reason.empty()) {
      return fail(fmt::format("the {} {} of joint {} ({}) of {} {}", name_of(which),
                              quantity_text(which, joints_[i].kind, values[i]), i + 1, joints_[i].name, id_, reason),
                  remedy(parameters_, which, joints_[i].kind, i));
    }
  }
  std::copy(values.begin(), values.end(), values_of(parameters_, which).begin());
  apply_limits(parameters_, joints_.size());
  return {};
}

Result<void> RobotModel::set_scalar_parameter(ScalarParameter which, double value) {
  if (!std::isfinite(value)) return fail(fmt::format("a parameter of {} is not a number", id_));
  const auto positive = [&](double& member, const char* name) -> Result<void> {
    if (!(value > 0.0)) return fail(fmt::format("the {} of {} is {:.6g}, but must be positive", name, id_, value));
    member = value;
    return {};
  };
  const auto scale = [&](double& member, const char* name) -> Result<void> {
    constexpr double kSmallest = 0.01;  // manual 1.2.2
    if (value < kSmallest || value > 1.0)
      return fail(fmt::format("the {} of {} is {:.6g}, but must be between 0.01 and 1", name, id_, value));
    member = value;
    return {};
  };
  switch (which) {
    case ScalarParameter::linear_velocity:
      return positive(parameters_.linear_velocity, "linear velocity");
    case ScalarParameter::linear_acceleration:
      return positive(parameters_.linear_acceleration, "linear acceleration");
    case ScalarParameter::rotational_velocity:
      return positive(parameters_.rotational_velocity, "rotational velocity");
    case ScalarParameter::rotational_acceleration:
      return positive(parameters_.rotational_acceleration, "rotational acceleration");
    case ScalarParameter::velocity_scale:
      return scale(parameters_.velocity_scale, "velocity scale");
    case ScalarParameter::acceleration_scale:
      return scale(parameters_.acceleration_scale, "acceleration scale");
    case ScalarParameter::program_delay:
      break;
  }
  constexpr double kLongestDelay = 86'400.0;  // s
  if (value < 0.0 || value > kLongestDelay)
    return fail(fmt::format("the program delay of {} is {:.6g} s, but must be between 0 and 86400 s", id_, value));
  parameters_.program_delay_s = value;
  return {};
}

Result<void> RobotModel::set_fly(FlyType type, double parameter) {
  const bool fraction = type == FlyType::speed_fraction;
  const bool angle = type == FlyType::angle;
  constexpr double kFarthestJoint = 1e3;  // m
  const double largest = fraction ? 1.0 : (angle ? std::numbers::pi : kFarthestJoint);
  if (!std::isfinite(parameter) || parameter < 0.0 || parameter > largest) {
    return fail(fmt::format("the fly parameter of {} is {:.6g}, but must be between 0 and {:.6g}{}", id_, parameter,
                            largest, fraction ? "" : (angle ? " rad" : " m")));
  }
  parameters_.fly_type = type;
  parameters_.fly_parameter = parameter;
  return {};
}

Result<void> RobotModel::set_point_of_reference(const Pose& X_FP) {
  if (auto checked = check_pose(X_FP, id_, "point of reference"); !checked) return checked;
  parameters_.X_FP = X_FP;
  return {};
}

Result<void> RobotModel::set_tool_center_point(const Pose& X_PT) {
  if (auto checked = check_pose(X_PT, id_, "tool centre point"); !checked) return checked;
  parameters_.X_PT = X_PT;
  return {};
}

Result<void> RobotModel::check_position(std::size_t i, double value) const {
  const JointKind kind = joints_[i].kind;
  const std::string joint = fmt::format("joint {} ({}) of {}", i + 1, joints_[i].name, id_);
  if (!std::isfinite(value)) return fail(fmt::format("the position of {} is not a number", joint));
  // A limit that was written in degrees may differ from the same number in radians by rounding.
  constexpr double kRounding = 1e-9;
  const bool below = value < parameters_.min_range[i] - kRounding;
  const bool above = value > parameters_.max_range[i] + kRounding;
  if (!below && !above) return {};
  return fail(fmt::format("{}: {} is {} its {} limit {}", joint, position_text(kind, value), below ? "below" : "above",
                          below ? "lower" : "upper",
                          position_text(kind, below ? parameters_.min_range[i] : parameters_.max_range[i])),
              "nothing was moved");
}

Result<void> RobotModel::check_count(std::size_t values) const {
  if (values <= joints_.size()) return {};
  return fail(fmt::format("{} has {} joints, but {} values are given", id_, joints_.size(), values),
              "give at most one value per joint");
}

Result<JointValues> RobotModel::positions_to(std::span<const double> values, const JointValues& current) const {
  if (auto counted = check_count(values.size()); !counted) return std::unexpected(counted.error());
  JointValues positions = current;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (auto checked = check_position(i, values[i]); !checked) return std::unexpected(checked.error());
    positions[i] = values[i];
  }
  return positions;
}

Result<JointValues> RobotModel::positions_by(std::span<const double> increments, const JointValues& current) const {
  if (auto counted = check_count(increments.size()); !counted) return std::unexpected(counted.error());
  JointValues positions = current;
  for (std::size_t i = 0; i < increments.size(); ++i) {
    // A joint that is not moved may stay where it is, even beyond a narrowed limit.
    if (increments[i] == 0.0) continue;
    const double wanted = current[i] + increments[i];
    if (auto checked = check_position(i, wanted); !checked) return std::unexpected(checked.error());
    positions[i] = wanted;
  }
  return positions;
}

}  // namespace cellmirror
