#include "rt_core/motion/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "rt_core/base/units.hpp"
#include "rt_core/motion/ptp.hpp"

namespace cellmirror::motion {

namespace {

constexpr double kSlack = 1e-9;  // rad or m; what the conversion of units costs

// The smaller one of those that are set.
double smaller(double active, double most, double otherwise) {
  const bool active_set = std::isfinite(active) && active > 0;
  const bool most_set = std::isfinite(most) && most > 0;
  if (active_set && most_set) return std::min(active, most);
  if (active_set) return active;
  return most_set ? most : otherwise;
}

std::string value_text(const kinematics::Variable& variable, double value) {
  if (variable.kind == JointKind::prismatic) return fmt::format("{:.6g} mm", mm_from_m(value));
  return fmt::format("{:.6g} deg", deg_from_rad(value));
}

}  // namespace

void set_joint_speeds(const kinematics::Chain& chain, const RobotParameters& parameters, Move& move) {
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    const double fallback = chain.rotates(i) ? kDefaultTurning : kDefaultSliding;
    move.velocity[i] = smaller(parameters.active_velocity[i], parameters.max_velocity[i], fallback);
    move.max_velocity[i] = smaller(0, parameters.max_velocity[i], move.velocity[i]);
    move.acceleration[i] = smaller(parameters.active_acceleration[i], parameters.max_acceleration[i],
                                   move.velocity[i] / kDefaultRampSeconds);
    move.min_velocity[i] = std::clamp(parameters.min_velocity[i], 0.0, move.max_velocity[i]);
  }
}

Result<Move> plan_joint_move(const kinematics::Chain& chain, const RobotParameters& parameters,
                             const JointValues& target) {
  Move move;
  move.kind = MoveKind::joints;
  move.profile = parameters.velocity_profile;
  move.ptp_mode = parameters.ptp_mode;
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    const kinematics::Variable& variable = chain.variables()[i];
    if (!std::isfinite(target[i])) {
      return fail(fmt::format("the target of joint {} ({}) is not a finite number", i + 1, variable.name));
    }
    if (target[i] < chain.lower()[i] - kSlack || target[i] > chain.upper()[i] + kSlack) {
      return fail(fmt::format("joint {} ({}) would be at {}, beyond its range {} .. {}", i + 1, variable.name,
                              value_text(variable, target[i]), value_text(variable, chain.lower()[i]),
                              value_text(variable, chain.upper()[i])),
                  "choose a target within its range, or widen the range with rob_jnt_min_range and rob_jnt_max_range");
    }
    move.target[i] = std::clamp(target[i], chain.lower()[i], chain.upper()[i]);
  }
  set_joint_speeds(chain, parameters, move);
  return move;
}

double duration_of(const Move& joint_move, const JointValues& from, std::size_t joints) {
  JointValues free_below;
  JointValues free_above;
  free_below.fill(-std::numeric_limits<double>::infinity());
  free_above.fill(std::numeric_limits<double>::infinity());
  const JointValues at_rest{};
  PtpMotion motion;
  motion.start(joint_move, std::span(from).first(joints), std::span(at_rest).first(joints),
               {std::span(free_below).first(joints), std::span(free_above).first(joints)});
  return motion.duration();
}

}  // namespace cellmirror::motion
