#include "rt_core/haptics/passivity.hpp"

#include <algorithm>

namespace cellmirror::haptics {

namespace {

constexpr double kLost = 100;  // allowances

}  // namespace

void Passivity::restart(const Eigen::Vector3d& p) CELL_RT {
  *this = Passivity{};
  p_ = p;
}

void Passivity::observe(const Eigen::Vector3d& p, const Eigen::Vector3d& held, double stored,
                        const PassivitySettings& settings, double period) CELL_RT {
  const Eigen::Vector3d way = p - p_;
  p_ = p;
  velocity_ = way / period;
  energy_ = std::min(energy_ - held.dot(way), stored);
  if (energy_ < 0) energy_ = std::min(0.0, energy_ + settings.allowance * period);
}

Eigen::Vector3d Passivity::control(const Eigen::Vector3d& force, bool in_contact, const PassivitySettings& settings,
                                   double period) CELL_RT {
  damping_ = 0;
  const double deficit = -settings.allowance - energy_;
  const double square = velocity_.squaredNorm();
  if (!in_contact || !settings.control || deficit <= 0 || square <= 0) return force;
  damping_ = std::min(deficit / (square * period), settings.max_damping);
  return force - damping_ * velocity_;
}

bool Passivity::lost(const PassivitySettings& settings) const CELL_RT {
  return settings.control && energy_ < -kLost * settings.allowance;
}

}  // namespace cellmirror::haptics
