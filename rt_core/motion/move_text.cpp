#include "rt_core/motion/move_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <string_view>

namespace cellmirror::motion {

namespace {

// Six digits; what rounds to zero has no sign.
std::string number(double value) {
  constexpr double kHalfDigit = 0.5e-6;
  return fmt::format("{:.6f}", std::abs(value) < kHalfDigit ? 0.0 : value);
}

std::string list(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + number(value);
  return text;
}

std::string pose_text(const Pose& X) {
  Eigen::Quaterniond q(X.linear());
  constexpr double kZero = 0.5e-6;
  // Half turns have two quaternions with w = 0: the first component that is not zero decides.
  const std::array parts = {q.w(), q.x(), q.y(), q.z()};
  for (const double part : parts) {
    if (std::abs(part) < kZero) continue;
    if (part < 0) q.coeffs() = -q.coeffs();
    break;
  }
  const Eigen::Vector3d p = X.translation();
  return list(std::array{p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
}

std::string task_text(const kinematics::Task& task) {
  std::string axes;
  for (int i = 0; i < 3; ++i) {
    if ((task.position_axes >> i & 1) != 0) axes += "xyz"[i];
  }
  constexpr std::array<std::string_view, 5> kOrientation = {"free", "full", "n", "s", "a"};
  return fmt::format("{}/{}{}{}", axes.empty() ? "-" : axes, kOrientation[static_cast<std::size_t>(task.orientation)],
                     task.orientation_required ? "" : "?",
                     task.secondary == kinematics::Secondary::even_bend ? "/even_bend" : "");
}

std::string fly_text(const Move& move) {
  constexpr std::array<std::string_view, 3> kFly = {"speed", "distance", "angle"};
  return fmt::format(" fly {} {}", kFly[static_cast<std::size_t>(move.fly_type)], number(move.fly_parameter));
}

std::string joints_text(const Move& move, std::size_t n) {
  return fmt::format("joints {} {} target [{}] velocity [{}] acceleration [{}]{} max [{}]",
                     move.ptp_mode == PtpMode::synchronous ? "sync" : "async",
                     move.profile == VelocityProfile::sine ? "sine" : "ramp", list(std::span(move.target).first(n)),
                     list(std::span(move.velocity).first(n)), list(std::span(move.acceleration).first(n)),
                     move.fly_parameter > 0 ? fly_text(move) : std::string(),
                     list(std::span(move.max_velocity).first(n)));
}

std::string path_text(const Move& move, std::size_t n) {
  const std::string via = move.kind == MoveKind::circular
                              ? fmt::format(" via [{}]", list(std::array{move.p_BV.x(), move.p_BV.y(), move.p_BV.z()}))
                              : std::string();
  return fmt::format("{} {}{} to [{}] task {} linear {} {} rotational {} {}{} max [{}] min [{}]",
                     move.kind == MoveKind::circular ? "circular" : "linear",
                     move.profile == VelocityProfile::sine ? "sine" : "ramp", via, pose_text(move.X_BG),
                     task_text(move.task), number(move.linear_velocity), number(move.linear_acceleration),
                     number(move.rotational_velocity), number(move.rotational_acceleration), fly_text(move),
                     list(std::span(move.max_velocity).first(n)), list(std::span(move.min_velocity).first(n)));
}

}  // namespace

std::string move_text(const Move& move, std::size_t joints) {
  const std::string head = fmt::format("{} {} ", move.id, move.start == Start::supersede ? "now" : "queued");
  switch (move.kind) {
    case MoveKind::joints:
      return head + joints_text(move, joints);
    case MoveKind::linear:
    case MoveKind::circular:
      return head + path_text(move, joints);
    case MoveKind::delay:
      return head + "delay " + number(move.delay_s);
  }
  return head;
}

}  // namespace cellmirror::motion
