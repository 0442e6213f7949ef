#include "app/owner/programs/move_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "rt_core/motion/planner.hpp"

namespace cellmirror::app {

namespace {

bool positive(double value) { return std::isfinite(value) && value > 0; }

Result<void> check_share(const std::optional<double>& share, std::string_view what) {
  if (!share || (positive(*share) && *share <= 1)) return {};
  return fail(fmt::format("the program asks for {:g} times the joints' maximum {}", *share, what),
              "a share is above 0 and at most 1");
}

// A Cartesian speed as the program sets it, or the share of the robot's own; the scale is no factor any more.
struct Speed {
  double& parameter;
  double scale;
  const std::optional<double>& set;
  const std::optional<double>& share;
  std::string_view what;
};

Result<void> put(const Speed& speed) {
  double& parameter = speed.parameter;
  parameter *= speed.scale;
  if (speed.share) {
    if (!positive(*speed.share) || *speed.share > 1) {
      return fail(fmt::format("the program asks for {:g} times the robot's {}", *speed.share, speed.what),
                  "a share is above 0 and at most 1");
    }
    parameter *= *speed.share;
  }
  if (!speed.set) return {};
  if (!positive(*speed.set))
    return fail(fmt::format("the program sets the {} to {:g}", speed.what, *speed.set), "it has to be positive");
  parameter = positive(parameter) ? std::min(parameter, *speed.set) : *speed.set;
  return {};
}

void put_joint_shares(const program::MotionSettings& set, std::span<const JointKind> joints, RobotParameters& out) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const double otherwise = joints[i] == JointKind::prismatic ? motion::kDefaultSliding : motion::kDefaultTurning;
    const double velocity = positive(out.max_velocity[i]) ? out.max_velocity[i] : otherwise;
    const double acceleration =
        positive(out.max_acceleration[i]) ? out.max_acceleration[i] : velocity / motion::kDefaultRampSeconds;
    if (set.joint_velocity) out.active_velocity[i] = *set.joint_velocity * velocity;
    if (set.joint_acceleration) out.active_acceleration[i] = *set.joint_acceleration * acceleration;
  }
}

}  // namespace

Result<RobotParameters> parameters_for(const RobotParameters& robot, std::span<const JointKind> joints,
                                       const program::MoveCommand& command) {
  const program::MotionSettings& set = command.settings;
  RobotParameters out = robot;
  const double velocity = robot.velocity_scale;
  const double acceleration = robot.acceleration_scale;
  for (const Result<void>& checked :
       {check_share(set.joint_velocity, "velocity"), check_share(set.joint_acceleration, "acceleration"),
        put({out.linear_velocity, velocity, set.linear_velocity, set.linear_velocity_share, "linear velocity"}),
        put({out.linear_acceleration, acceleration, set.linear_acceleration, set.linear_acceleration_share,
             "linear acceleration"}),
        put({out.rotational_velocity, velocity, set.rotational_velocity, set.rotational_velocity_share,
             "rotational velocity"}),
        put({out.rotational_acceleration, acceleration, set.rotational_acceleration, set.rotational_acceleration_share,
             "rotational acceleration"})}) {
    if (!checked) return std::unexpected(checked.error());
  }
  out.velocity_scale = 1;
  out.acceleration_scale = 1;
  put_joint_shares(set, joints, out);
  if (set.fly_type) {
    out.fly_type = *set.fly_type;
    out.fly_parameter = set.fly_parameter;
  }
  if (!command.fly || !positive(out.fly_parameter)) out.fly_parameter = 0;
  return out;
}

}  // namespace cellmirror::app
