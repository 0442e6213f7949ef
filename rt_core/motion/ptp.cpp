#include "rt_core/motion/ptp.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::motion {

namespace {

AxisLimits limits_of(const Move& move, const JointValues& acceleration, const JointRange& range,
                     std::size_t i) CELL_RT {
  return {std::min(move.velocity[i], move.max_velocity[i]), acceleration[i], range.lower[i], range.upper[i]};
}

}  // namespace

void PtpMotion::set_duration(std::size_t joints) CELL_RT {
  t_ = 0;
  duration_ = 0;
  for (std::size_t i = 0; i < joints; ++i) duration_ = std::max(duration_, axes_[i].duration());
}

// At the accelerations in acceleration_.
void PtpMotion::plan(const Move& move, std::span<const double> q, std::span<const double> qd,
                     const JointRange& range) CELL_RT {
  for (std::size_t i = 0; i < q.size(); ++i) {
    const AxisLimits limits = limits_of(move, acceleration_, range, i);
    cruise_[i] = limits.velocity;
    axes_[i] = Profile::to_target(q[i], qd[i], move.target[i], limits, move.profile);
  }
  set_duration(q.size());
  if (move.ptp_mode == PtpMode::asynchronous) return;
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (axes_[i].duration() >= duration_ || axes_[i].duration() <= 0) continue;
    AxisLimits limits = limits_of(move, acceleration_, range, i);
    limits.velocity = Profile::velocity_for(duration_, q[i], qd[i], move.target[i], limits, move.profile);
    cruise_[i] = limits.velocity;
    axes_[i] = Profile::to_target(q[i], qd[i], move.target[i], limits, move.profile);
  }
}

void PtpMotion::start(const Move& move, std::span<const double> q, std::span<const double> qd,
                      const JointRange& range) CELL_RT {
  acceleration_ = move.acceleration;
  fly_parameter_ = 0;
  plan(move, q, qd, range);
}

double PtpMotion::catch_up(const Move& move, double lag, std::span<const double> q, const JointRange& range) CELL_RT {
  if (!(lag > 0) || !(duration_ > 0)) return 0;
  const double before = duration_;
  double harder = 1;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double velocity = std::min(move.velocity[i], move.max_velocity[i]);
    harder = std::max(harder,
                      Profile::acceleration_for(before - lag, move.target[i] - q[i], velocity) / move.acceleration[i]);
  }
  harder = std::min(harder, kHardestCatchUp);
  for (std::size_t i = 0; i < q.size(); ++i) acceleration_[i] = harder * move.acceleration[i];
  const JointValues at_rest{};
  plan(move, q, std::span(at_rest).first(q.size()), range);
  return before - duration_;
}

void PtpMotion::set_fly_point(const Move& move, const kinematics::Chain* chain) CELL_RT {
  fly_type_ = move.fly_type;
  fly_parameter_ = move.fly_parameter;
  chain_ = chain;
  if (fly_parameter_ > 0 && fly_type_ != FlyType::speed_fraction && chain_ != nullptr)
    X_BG_ = kinematics::forward(*chain_, std::span(move.target).first(chain_->variable_count()));
}

// By distance and by angle too only where every axis brakes: the TCP may be near its target all the way, while a wrist
// turns.
bool PtpMotion::at_fly_point(std::span<const double> q) const CELL_RT {
  if (fly_parameter_ <= 0) return false;
  const bool by_speed = fly_type_ == FlyType::speed_fraction;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Profile::State state = axes_[i].at(t_);
    if (!state.braking_to_target) return false;
    if (by_speed && std::abs(state.velocity) >= fly_parameter_ * cruise_[i]) return false;
  }
  if (by_speed) return true;
  if (chain_ == nullptr || chain_->variable_count() != q.size()) return false;
  const kinematics::Twist left = kinematics::pose_error(kinematics::forward(*chain_, q), X_BG_);
  return (fly_type_ == FlyType::distance ? left.head<3>() : left.tail<3>()).norm() < fly_parameter_;
}

PaceChange PtpMotion::pace_change(double pace, std::size_t joints) const CELL_RT {
  PaceChange change;
  for (std::size_t i = 0; i < joints; ++i) {
    const Profile::State state = axes_[i].at(t_);
    change.bound(state.velocity, state.acceleration, acceleration_[i], pace);
  }
  return change;
}

void PtpMotion::brake(std::span<const double> q, std::span<const double> qd, const JointRange& range) CELL_RT {
  for (std::size_t i = 0; i < q.size(); ++i) {
    axes_[i] = Profile::to_rest(q[i], qd[i], {0, acceleration_[i], range.lower[i], range.upper[i]});
  }
  set_duration(q.size());
}

void PtpMotion::brake_together(const JointValues& acceleration, std::span<const double> q, std::span<const double> qd,
                               const JointRange& range) CELL_RT {
  constexpr double kOtherwise = 0.1;  // s
  constexpr double kLeast = 1e-6;     // rad/s2, m/s2; of an axis at rest
  double duration = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double own = acceleration[i] > 0 ? std::abs(qd[i]) / acceleration[i] : kOtherwise;
    duration = std::max(duration, own);
  }
  for (std::size_t i = 0; i < q.size(); ++i) {
    acceleration_[i] = duration > 0 ? std::max(std::abs(qd[i]) / duration, kLeast) : kLeast;
  }
  brake(q, qd, range);
}

bool PtpMotion::advance(double dt, std::span<double> q, std::span<double> qd) CELL_RT {
  t_ += dt;
  const bool arrived = t_ >= duration_;
  for (std::size_t i = 0; i < q.size(); ++i) {
    // At the end all of them at rest, also one whose stretched profile is longer by a rounding.
    const Profile::State state = axes_[i].at(arrived ? axes_[i].duration() : t_);
    q[i] = state.position;
    qd[i] = state.velocity;
  }
  return arrived;
}

}  // namespace cellmirror::motion
