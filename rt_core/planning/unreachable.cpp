#include "rt_core/planning/unreachable.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "rt_core/base/units.hpp"

namespace cellmirror::planning {

namespace {

constexpr std::size_t kJointsForAnyPose = 6;

double tidy(double value) { return std::abs(value) < 0.05 ? 0.0 : value; }  // no -0.0

// An error that is too small for one digit behind the point is not told as none.
std::string short_number(double value) {
  constexpr double kNone = 1e-4;
  if (value < kNone) return "0";
  return value < 0.1 ? fmt::format("{:.2g}", value) : fmt::format("{:.1f}", value);
}

// What of the target is not met, as far as people care.
std::string unmet_components(const kinematics::Twist& error) {
  constexpr double kShownLength = 1e-4;  // m
  constexpr double kShownAngle = 1e-3;   // rad
  constexpr std::array<std::string_view, 6> kNames = {
      "x", "y", "z", "the rotation about x", "the rotation about y", "the rotation about z"};
  std::string text;
  for (int i = 0; i < 6; ++i) {
    const double value = std::abs(error(i));
    if (value <= (i < 3 ? kShownLength : kShownAngle)) continue;
    text += fmt::format(
        "{}{} by {}", text.empty() ? "" : ", ", kNames[static_cast<std::size_t>(i)],
        i < 3 ? fmt::format("{:.1f} mm", mm_from_m(value)) : fmt::format("{:.1f} degrees", deg_from_rad(value)));
  }
  return text;
}

// A target within a hand's breadth of the robot's own zero point: its lengths were likely written in metres.
std::string lengths_in_metres(const Pose& X_ZG) {
  constexpr double kNearZero = 0.01;  // m
  const Eigen::Vector3d p = X_ZG.translation() / kMPerMm;
  if (X_ZG.translation().norm() >= kNearZero) return {};
  return fmt::format("lengths are in mm, and x {:.3g} y {:.3g} z {:.3g} mm is nearly the robot's own zero point", p.x(),
                     p.y(), p.z());
}

}  // namespace

Error line_refused(const RobotModel& robot, Error why, const Pose& X_ZG) {
  if (std::string metres = lengths_in_metres(X_ZG); !metres.empty()) {
    why.remedy = std::move(metres);
    return why;
  }
  if (robot.joint_count() >= kJointsForAnyPose) return why;
  why.what += fmt::format("; {} has {} joints", robot.id(), robot.joint_count());
  why.remedy += why.remedy.empty() ? "" : "; ";
  why.remedy += "rob_inverse_class says what of the pose has to be met, e.g. rob_inverse_class align_POS";
  return why;
}

std::string pose_text(const Pose& X) {
  const Eigen::Vector3d p = X.translation() / kMPerMm;
  const Eigen::Vector3d rpy = rpy_from_rotation(X.linear()) / kRadPerDeg;
  return fmt::format("x {:.1f} y {:.1f} z {:.1f} mm, roll {:.1f} pitch {:.1f} yaw {:.1f} degrees", tidy(p.x()),
                     tidy(p.y()), tidy(p.z()), tidy(rpy.x()), tidy(rpy.y()), tidy(rpy.z()));
}

Error unreachable(const RobotModel& robot, const inverse_kinematics::Answer& answer, const Pose& X_ZG,
                  const Pose& X_ZN) {
  std::string what = fmt::format("{} cannot reach this pose", robot.id());
  if (!answer.solutions.empty()) {
    const kinematics::Twist& error = answer.solutions.front().error;
    what += fmt::format("; the nearest that was found is {} mm and {} degrees away: {}",
                        short_number(mm_from_m(error.head<3>().norm())),
                        short_number(deg_from_rad(error.tail<3>().norm())), pose_text(X_ZN));
    if (std::string metres = lengths_in_metres(X_ZG); !metres.empty()) return {std::move(what), std::move(metres)};
    if (robot.joint_count() < kJointsForAnyPose) {
      const std::string unmet = unmet_components(error);
      if (!unmet.empty()) what += fmt::format("; with {} joints it does not meet {}", robot.joint_count(), unmet);
      return {std::move(what),
              "rob_inverse_class says what has to be met, e.g. rob_inverse_class align_POS for the position alone"};
    }
  }
  return {std::move(what), "nothing was moved; command that pose, or ask for less with rob_inverse_class"};
}

}  // namespace cellmirror::planning
