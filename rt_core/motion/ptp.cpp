#include "rt_core/motion/ptp.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::motion {

namespace {

AxisLimits limits_of(const Move& move, const JointRange& range, std::size_t i) CELL_RT {
  return {std::min(move.velocity[i], move.max_velocity[i]), move.acceleration[i], range.lower[i], range.upper[i]};
}

}  // namespace

void PtpMotion::set_duration(std::size_t joints) CELL_RT {
  t_ = 0;
  duration_ = 0;
  for (std::size_t i = 0; i < joints; ++i) duration_ = std::max(duration_, axes_[i].duration());
}

void PtpMotion::start(const Move& move, std::span<const double> q, std::span<const double> qd,
                      const JointRange& range) CELL_RT {
  acceleration_ = move.acceleration;
  for (std::size_t i = 0; i < q.size(); ++i) {
    axes_[i] = Profile::to_target(q[i], qd[i], move.target[i], limits_of(move, range, i), move.profile);
  }
  set_duration(q.size());
  if (move.ptp_mode == PtpMode::asynchronous) return;
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (axes_[i].duration() >= duration_ || axes_[i].duration() <= 0) continue;
    AxisLimits limits = limits_of(move, range, i);
    limits.velocity = Profile::velocity_for(duration_, q[i], qd[i], move.target[i], limits, move.profile);
    axes_[i] = Profile::to_target(q[i], qd[i], move.target[i], limits, move.profile);
  }
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
  constexpr double kLeast = 1e-6;     // rad/s2, m/s2; of an axis that stands
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
