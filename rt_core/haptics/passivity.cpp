#include "rt_core/haptics/passivity.hpp"

#include <algorithm>

namespace cellmirror::haptics {

namespace {

constexpr double kLost = 100;               // allowances
constexpr double kForgivenPerSecond = 0.1;  // allowances: what a body that moves against the hand may add up to
constexpr double kRecovery = 0.1;           // s, in which the force comes back after a cut

}  // namespace

void Passivity::restart(const Eigen::Vector3d& p) CELL_RT {
  *this = Passivity{};
  p_ = p;
}

void Passivity::observe(const Eigen::Vector3d& p, const Eigen::Vector3d& force, double stored,
                        const PassivitySettings& settings, double period) CELL_RT {
  const Eigen::Vector3d step = p - p_;
  change_ = step - step_;
  step_ = step;
  p_ = p;
  energy_ = std::min(energy_ - applied_.dot(step), stored);
  if (energy_ < 0) energy_ = std::min(0.0, energy_ + kForgivenPerSecond * settings.allowance * period);
  applied_ = force;
}

Eigen::Vector3d Passivity::control(const Eigen::Vector3d& wanted, const PassivitySettings& settings,
                                   double period) CELL_RT {
  damping_ = 0;
  if (!settings.control) return wanted;
  share_ = std::min(1.0, share_ + period / kRecovery);
  const Eigen::Vector3d force = share_ * wanted;
  // In the next period the force of the last tick acts, in the one after it this one.
  const Eigen::Vector3d next = step_ + change_;
  const Eigen::Vector3d after = next + change_;
  const double given = force.dot(after);
  const double excess = given - (energy_ - applied_.dot(next) + settings.allowance);
  if (given <= 0 || excess <= 0) return force;
  const double square = after.squaredNorm();
  const double cut = std::min(std::min(excess, given) / square, settings.max_damping / period);
  damping_ = cut * period;
  const Eigen::Vector3d left = force - cut * after;
  share_ = std::clamp(wanted.dot(left) / wanted.squaredNorm(), 0.0, share_);
  return left;
}

bool Passivity::lost(const PassivitySettings& settings) const CELL_RT {
  return settings.control && energy_ < -kLost * settings.allowance;
}

}  // namespace cellmirror::haptics
