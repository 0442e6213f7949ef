#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "rt_core/base/units.hpp"
#include "rt_core/kinematics/fast_step.hpp"
#include "rt_core/motion/linear.hpp"
#include "rt_core/motion/planner.hpp"

namespace cellmirror::motion {

namespace {

constexpr double kStepLength = 0.005;            // m
constexpr double kStepAngle = 1.0 * kRadPerDeg;  // rad
constexpr int kLeastSteps = 16;
constexpr int kMostSteps = 2000;
constexpr double kLargestTurn = 10.0 * kRadPerDeg;  // of a joint within one step, before the step is halved
constexpr double kLargestSlide = 0.05;              // m
constexpr int kHalvings = 8;
constexpr kinematics::FastOptions kOptions{.tolerance = kPathTolerance, .max_iterations = 20};
constexpr double kAtLimit = 1e-6;  // rad or m

// The joint that moved too far for one step; none: variable_count().
std::size_t jumping_joint(const kinematics::Chain& chain, const JointValues& from, const JointValues& to) {
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    if (std::abs(to[i] - from[i]) > (chain.rotates(i) ? kLargestTurn : kLargestSlide)) return i;
  }
  return chain.variable_count();
}

std::string joint_text(const kinematics::Chain& chain, std::size_t i) {
  return fmt::format("joint {} ({})", i + 1, chain.variables()[i].name);
}

// Follows the way; `share` is how far it got.
class Trial {
 public:
  Trial(const kinematics::Chain& chain, const Move& move, const Way& way, const Pose& X_BS, const JointValues& from)
      : chain_(chain), move_(move), way_(way), X_BS_(X_BS), q_(from) {}

  // Why it cannot continue; empty if it reached the end.
  std::string run() {
    const double extent = std::max(way_.length / kStepLength, way_.angle / kStepAngle);
    const int steps =
        std::clamp(static_cast<int>(std::min(std::ceil(extent), 1.0 * kMostSteps)), kLeastSteps, kMostSteps);
    for (int i = 1; i <= steps; ++i) {
      if (std::string why = go_to(static_cast<double>(i) / steps, kHalvings); !why.empty()) return why;
    }
    return {};
  }

  [[nodiscard]] double share() const { return share_; }
  [[nodiscard]] const JointValues& posture() const { return q_; }

 private:
  // NOLINTNEXTLINE(misc-no-recursion): kHalvings bounds it.
  std::string go_to(double share, int halvings) {
    JointValues next = q_;
    const std::span<double> q = std::span(next).first(chain_.variable_count());
    const kinematics::FastResult found =
        kinematics::fast_solve(chain_, move_.task, way_.moved(X_BS_, share), q, kOptions);
    const bool met = found.solved || kinematics::meets(move_.task, found.error, kPathTaken);
    const std::size_t jumping = jumping_joint(chain_, q_, next);
    if (met && jumping == chain_.variable_count()) {
      q_ = next;
      share_ = share;
      return {};
    }
    if (halvings > 0) {
      if (std::string why = go_to(0.5 * (share_ + share), halvings - 1); !why.empty()) return why;
      return go_to(share, halvings - 1);
    }
    return met ? joint_text(chain_, jumping) + " would need infinite velocity" : reason(next);
  }

  [[nodiscard]] std::string reason(const JointValues& q) const {
    for (std::size_t i = 0; i < chain_.variable_count(); ++i) {
      if (q[i] - chain_.lower()[i] < kAtLimit || chain_.upper()[i] - q[i] < kAtLimit)
        return joint_text(chain_, i) + " is at the end of its range";
    }
    return "it is out of reach";
  }

  const kinematics::Chain& chain_;
  const Move& move_;
  const Way& way_;
  const Pose& X_BS_;
  JointValues q_;
  double share_ = 0;
};

std::string progress_text(const Way& way, double share) {
  if (way.length > 1e-9)
    return fmt::format("{:.1f} of {:.1f} mm", mm_from_m(share * way.length), mm_from_m(way.length));
  return fmt::format("{:.1f} of {:.1f} deg", deg_from_rad(share * way.angle), deg_from_rad(way.angle));
}

double scaled(double value, double scale, double otherwise) {
  const double wanted = value * scale;
  return std::isfinite(wanted) && wanted > 0 ? wanted : otherwise;
}

// A straight line by the parameters.
Move path_move(const kinematics::Chain& chain, const RobotParameters& parameters, const Pose& X_BG) {
  const RobotParameters defaults;
  Move move;
  move.kind = MoveKind::linear;
  move.profile = parameters.velocity_profile;
  move.X_BG = X_BG;
  move.task = kinematics::task_of(parameters.inverse_class, chain);
  move.linear_velocity = scaled(parameters.linear_velocity, parameters.velocity_scale, defaults.linear_velocity);
  move.linear_acceleration =
      scaled(parameters.linear_acceleration, parameters.acceleration_scale, defaults.linear_acceleration);
  move.rotational_velocity =
      scaled(parameters.rotational_velocity, parameters.velocity_scale, defaults.rotational_velocity);
  move.rotational_acceleration =
      scaled(parameters.rotational_acceleration, parameters.acceleration_scale, defaults.rotational_acceleration);
  move.fly_type = parameters.fly_type;
  move.fly_parameter = std::max(parameters.fly_parameter, 0.0);
  set_joint_speeds(chain, parameters, move);
  return move;
}

Result<PathPlan> try_out(const kinematics::Chain& chain, const Move& move, const JointValues& from) {
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    if (from[i] >= chain.lower()[i] - kAtLimit && from[i] <= chain.upper()[i] + kAtLimit) continue;
    return fail(fmt::format("{} is beyond its range (or unknown); a {} move cannot start from there",
                            joint_text(chain, i), move.kind == MoveKind::circular ? "circular" : "linear"),
                "bring it back with POS_ROB JOINT_ABS");
  }
  PathPlan plan;
  plan.move = move;
  const Pose X_BS = kinematics::forward(chain, std::span(from).first(chain.variable_count()));
  const Way way = Way::between(move, X_BS, move.X_BG);
  Trial trial(chain, plan.move, way, X_BS, from);
  if (const std::string why = trial.run(); !why.empty()) {
    return fail(
        fmt::format("the {} is possible for {} only: {}", move.kind == MoveKind::circular ? "arc" : "straight line",
                    progress_text(way, trial.share()), why),
        "a joint (PTP) move to the same target may succeed");
  }
  plan.end = trial.posture();
  plan.duration_s = way.share.duration();
  return plan;
}

}  // namespace

Result<PathPlan> plan_linear_move(const kinematics::Chain& chain, const RobotParameters& parameters,
                                  const JointValues& from, const Pose& X_BG) {
  if (!kinematics::is_pose(X_BG)) return fail("the target of the linear move is not a pose of finite numbers");
  return try_out(chain, path_move(chain, parameters, X_BG), from);
}

Result<PathPlan> plan_circular_move(const kinematics::Chain& chain, const RobotParameters& parameters,
                                    const JointValues& from, const Eigen::Vector3d& p_BV, const Pose& X_BG) {
  if (!kinematics::is_pose(X_BG) || !p_BV.allFinite())
    return fail("the points of the circular move are not poses of finite numbers");
  Move move = path_move(chain, parameters, X_BG);
  move.kind = MoveKind::circular;
  move.p_BV = p_BV;
  if (move.task.position_axes != 0b111)
    return fail("rob_inverse_class leaves a part of the position open, so the TCP cannot follow an arc",
                "choose one with the whole position, such as ALIGN_FRAME");
  const Pose X_BS = kinematics::forward(chain, std::span(from).first(chain.variable_count()));
  if (!Arc::through(X_BS.translation(), p_BV, X_BG.translation())) {
    return fail(
        "there is no arc through the start, the via point and the target: two of them coincide, or all lie on one "
        "line",
        "choose three distinct points; a full circle needs two arcs, a straight path a linear move");
  }
  return try_out(chain, move, from);
}

}  // namespace cellmirror::motion
