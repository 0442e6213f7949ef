#include "rt_core/planning/trajectory_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "rt_core/base/text.hpp"
#include "rt_core/motion/planner.hpp"

namespace cellmirror::planning {

namespace {

using motion::KnotOrder;
using motion::KnotState;
using motion::Trajectory;

constexpr double kSlack = 1e-9;             // rad or m; as the limiter's
constexpr double kStandsStill = 1e-5;       // rad/s or m/s: what a planner rounds to
constexpr double kLargestValue = 1e6;       // rad, m and their derivatives: polynomials stay finite
constexpr double kLongestTrajectory = 1e6;  // s

std::unexpected<TrajectoryFault> refuse(TrajectoryRefusal refusal, std::string text) {
  return std::unexpected(TrajectoryFault{refusal, std::move(text)});
}

// By column of the message, the joint of the controller.
using Columns = std::vector<const TrajectoryJoint*>;

std::expected<Columns, TrajectoryFault> columns_of(const TrajectoryController& controller,
                                                   const JointTrajectory& message) {
  Columns columns;
  for (const std::string& name : message.joints) {
    const auto known = std::ranges::find(controller.joints, name, &TrajectoryJoint::name);
    if (known == controller.joints.end())
      return refuse(TrajectoryRefusal::joints, fmt::format("the controller has no joint {}", printable(name)));
    if (std::ranges::find(columns, &*known) != columns.end())
      return refuse(TrajectoryRefusal::joints, fmt::format("the joint {} is named twice", name));
    columns.push_back(&*known);
  }
  if (columns.empty()) return refuse(TrajectoryRefusal::joints, "no joint is named");
  if (controller.allow_partial) return columns;
  for (const TrajectoryJoint& joint : controller.joints) {
    if (std::ranges::find(columns, &joint) == columns.end())
      return refuse(TrajectoryRefusal::joints, fmt::format("the joint {} is missing", joint.name));
  }
  return columns;
}

std::optional<TrajectoryFault> check_values(const std::vector<double>& values, const char* what, std::size_t point,
                                            const JointTrajectory& message) {
  if (values.empty()) return std::nullopt;
  if (values.size() != message.joints.size())
    return TrajectoryFault{TrajectoryRefusal::sizes, fmt::format("point {} has {} {} for {} joints", point + 1,
                                                                 values.size(), what, message.joints.size())};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(std::abs(values[i]) <= kLargestValue))
      return TrajectoryFault{TrajectoryRefusal::not_finite,
                             fmt::format("the {} of {} in point {} are {}", what, message.joints[i], point + 1,
                                         std::isfinite(values[i]) ? "too large" : "not finite")};
  }
  return std::nullopt;
}

std::optional<TrajectoryFault> check_points(const JointTrajectory& message) {
  Nanoseconds before{-1};
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    const TrajectoryPoint& point = message.points[i];
    if (point.time_from_start < Nanoseconds(0) || seconds(point.time_from_start) > kLongestTrajectory)
      return TrajectoryFault{TrajectoryRefusal::times, fmt::format("point {} is at {:.3f} s from the start", i + 1,
                                                                   seconds(point.time_from_start))};
    if (point.time_from_start <= before)
      return TrajectoryFault{TrajectoryRefusal::times, fmt::format("point {} is at {:.6f} s, not after the one before",
                                                                   i + 1, seconds(point.time_from_start))};
    before = point.time_from_start;
    if (point.positions.empty())
      return TrajectoryFault{TrajectoryRefusal::no_positions, fmt::format("point {} has no positions", i + 1)};
    for (const auto& [values, what] : {std::pair{&point.positions, "positions"},
                                       {&point.velocities, "velocities"},
                                       {&point.accelerations, "accelerations"},
                                       {&point.effort, "efforts"}}) {
      if (auto fault = check_values(*values, what, i, message)) return fault;
    }
  }
  const std::vector<double>& end = message.points.back().velocities;
  for (std::size_t i = 0; i < end.size(); ++i) {
    if (std::abs(end[i]) > kStandsStill)
      return TrajectoryFault{TrajectoryRefusal::end_velocity,
                             fmt::format("{} has the velocity {:.6g} in the last point", message.joints[i], end[i])};
  }
  return std::nullopt;
}

double first_positive(double a, double b, double otherwise) {
  if (std::isfinite(a) && a > 0) return a;
  return std::isfinite(b) && b > 0 ? b : otherwise;
}

void set_limits(const TrajectoryRobot& robot, Trajectory& out) {
  const RobotParameters& all = robot.parameters;
  for (std::size_t i = 0; i < out.joints; ++i) {
    const double fallback = robot.kinds[i] == JointKind::prismatic ? motion::kDefaultSliding : motion::kDefaultTurning;
    out.max_velocity[i] = first_positive(all.max_velocity[i], all.active_velocity[i], fallback);
    out.deceleration[i] = first_positive(all.max_acceleration[i], all.active_acceleration[i],
                                         out.max_velocity[i] / motion::kDefaultRampSeconds);
  }
}

double tolerance(double of_goal, double of_controller) {
  if (of_goal < 0) return 0;
  return of_goal > 0 ? of_goal : of_controller;
}

std::optional<TrajectoryFault> set_tolerances(const TrajectoryController& controller, const TrajectoryGoal* goal,
                                              Trajectory& out) {
  for (const TrajectoryJoint& joint : controller.joints) {
    out.path_tolerance[joint.number] = joint.path_tolerance;
    out.goal_tolerance[joint.number] = joint.goal_tolerance;
    out.stopped_velocity[joint.number] = joint.stopped_velocity;
  }
  out.goal_time = controller.goal_time;
  if (goal == nullptr) return std::nullopt;
  for (const auto& [given, values] :
       {std::pair{&goal->path, &out.path_tolerance}, {&goal->goal, &out.goal_tolerance}}) {
    for (const TrajectoryTolerance& one : *given) {
      const auto joint = std::ranges::find(controller.joints, one.joint, &TrajectoryJoint::name);
      if (joint == controller.joints.end())
        return TrajectoryFault{TrajectoryRefusal::joints,
                               fmt::format("a tolerance names {}, which the controller has not", printable(one.joint))};
      if (!(std::abs(one.position) <= kLargestValue) || !(std::abs(one.velocity) <= kLargestValue))
        return TrajectoryFault{TrajectoryRefusal::not_finite,
                               fmt::format("a tolerance of {} is not finite, or too large", one.joint)};
      double& position = (*values)[joint->number];
      position = tolerance(one.position, position);
      if (values != &out.goal_tolerance) continue;
      double& velocity = out.stopped_velocity[joint->number];
      velocity = tolerance(one.velocity, velocity);
    }
  }
  out.goal_time = std::min(tolerance(seconds(goal->goal_time), out.goal_time), kLongestTrajectory);
  return std::nullopt;
}

void set_points(const Columns& columns, const JointTrajectory& message, Trajectory& out) {
  for (const TrajectoryJoint* joint : columns) out.given = static_cast<std::uint16_t>(out.given | 1U << joint->number);
  out.knots.resize(message.points.size() * out.joints);
  KnotState* knots = out.knots.data();
  for (const TrajectoryPoint& point : message.points) {
    const bool has_velocities = !point.velocities.empty();
    const bool has_accelerations = has_velocities && !point.accelerations.empty();
    out.times.push_back(seconds(point.time_from_start));
    out.orders.push_back(has_accelerations ? KnotOrder::accelerations
                         : has_velocities  ? KnotOrder::velocities
                                           : KnotOrder::positions);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      KnotState& knot = knots[columns[i]->number];
      knot.position = point.positions[i];
      if (has_velocities) knot.velocity = point.velocities[i];
      if (has_accelerations) knot.acceleration = point.accelerations[i];
    }
    knots += out.joints;
  }
}

// A polynomial on [0, 1] as a Bezier curve: it stays within the hull of its control points (Farin, Curves and Surfaces
// for CAGD, 4.3). Halves until that decides. `at`: where it is outside.
using Bezier = std::array<double, 6>;

Bezier bezier_of(const std::array<double, 6>& polynomial, double duration) {
  constexpr std::size_t kDegree = 5;
  constexpr std::array<std::array<double, 6>, 6> kBinomial = {{{1, 0, 0, 0, 0, 0},
                                                               {1, 1, 0, 0, 0, 0},
                                                               {1, 2, 1, 0, 0, 0},
                                                               {1, 3, 3, 1, 0, 0},
                                                               {1, 4, 6, 4, 1, 0},
                                                               {1, 5, 10, 10, 5, 1}}};
  Bezier out{};
  double power = 1;
  for (std::size_t i = 0; i <= kDegree; ++i) {
    for (std::size_t j = i; j <= kDegree; ++j)
      out[j] += kBinomial[j][i] / kBinomial[kDegree][i] * polynomial[i] * power;
    power *= duration;
  }
  return out;
}

std::optional<double> leaves(const Bezier& curve, double lower, double upper, double from, double to, int depth) {
  const auto inside = [&](double value) { return value >= lower - kSlack && value <= upper + kSlack; };
  if (std::ranges::all_of(curve, inside)) return std::nullopt;
  if (!inside(curve.front())) return from;
  if (!inside(curve.back())) return to;
  if (depth == 0) return std::nullopt;
  Bezier left = curve;
  Bezier right = curve;
  for (std::size_t step = 1; step < left.size(); ++step) {  // de Casteljau
    for (std::size_t i = left.size() - 1; i >= step; --i) left[i] = 0.5 * (left[i] + left[i - 1]);
    for (std::size_t i = 0; i + step < right.size(); ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
  }
  const double middle = 0.5 * (from + to);
  if (const auto at = leaves(left, lower, upper, from, middle, depth - 1)) return at;
  return leaves(right, lower, upper, middle, to, depth - 1);
}

TrajectoryFault beyond(const TrajectoryJoint& joint, double value, double time, double lower, double upper) {
  return {TrajectoryRefusal::beyond_range,
          fmt::format("{} would be at {:.6g} after {:.3f} s, beyond its range {:.6g} to {:.6g}", joint.name, value,
                      time, lower, upper)};
}

// The way from the present posture to the first point is the tick's own affair: there joints stop at their limits.
std::optional<TrajectoryFault> check_range(const Columns& columns, const TrajectoryRobot& robot,
                                           const Trajectory& trajectory) {
  constexpr int kHalvings = 16;
  for (const TrajectoryJoint* joint : columns) {
    const std::size_t i = joint->number;
    const double lower = robot.parameters.min_range[i];
    const double upper = robot.parameters.max_range[i];
    for (std::size_t point = 0; point < trajectory.points(); ++point) {
      const double position = trajectory.knot(point, i).position;
      if (position < lower - kSlack || position > upper + kSlack)
        return beyond(*joint, position, trajectory.times[point], lower, upper);
    }
    for (std::size_t point = 1; point < trajectory.points(); ++point) {
      const motion::KnotPair pair{std::min(trajectory.orders[point - 1], trajectory.orders[point]),
                                  trajectory.times[point] - trajectory.times[point - 1]};
      if (pair.order == KnotOrder::positions) continue;
      const KnotState& from = trajectory.knot(point - 1, i);
      const KnotState& to = trajectory.knot(point, i);
      const Bezier curve = bezier_of(motion::polynomial(pair, from, to), pair.duration);
      const auto at = leaves(curve, lower, upper, 0.0, pair.duration, kHalvings);
      if (!at) continue;
      const double position = motion::interpolate(pair, from, to, *at).position;
      return beyond(*joint, position, trajectory.times[point - 1] + *at, lower, upper);
    }
  }
  return std::nullopt;
}

}  // namespace

std::expected<Trajectory, TrajectoryFault> plan_trajectory(const TrajectoryController& controller,
                                                           const TrajectoryRobot& robot, const JointTrajectory& message,
                                                           const TrajectoryGoal* goal, const TrajectoryTimes& times) {
  const auto columns = columns_of(controller, message);
  if (!columns) return std::unexpected(columns.error());
  if (goal != nullptr && goal->multi_dof)
    return refuse(TrajectoryRefusal::joints, "joints with several axes are not supported");
  if (message.points.size() > kMaxTrajectoryPoints)
    return refuse(TrajectoryRefusal::too_many_points,
                  fmt::format("{} points, at most {} are taken", message.points.size(), kMaxTrajectoryPoints));
  if (auto fault = check_points(message)) return std::unexpected(*std::move(fault));
  if (times.start.known()) {
    const Nanoseconds since_end = times.now - times.start - message.points.back().time_from_start;
    if (since_end > Nanoseconds(0))
      return refuse(TrajectoryRefusal::past, fmt::format("it ended {:.3f} s ago", seconds(since_end)));
  }
  Trajectory out;
  out.start = times.start;
  out.joints = static_cast<std::uint8_t>(robot.kinds.size());
  set_limits(robot, out);
  if (auto fault = set_tolerances(controller, goal, out)) return std::unexpected(*std::move(fault));
  set_points(*columns, message, out);
  if (auto fault = check_range(*columns, robot, out)) return std::unexpected(*std::move(fault));
  return out;
}

}  // namespace cellmirror::planning
