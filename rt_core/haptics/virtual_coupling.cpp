#include "rt_core/haptics/virtual_coupling.hpp"

#include <algorithm>

namespace cellmirror::haptics {

namespace {

// Encoders count in steps, so that differences of one tick are mostly noise.
constexpr double kRateTime = 0.002;  // s, of the filter on velocities

}  // namespace

void VirtualCoupling::restart() CELL_RT { *this = VirtualCoupling{}; }

void VirtualCoupling::fade(double engage_time, double period) CELL_RT {
  share_ = engage_time > period ? std::min(1.0, share_ + period / engage_time) : 1.0;
}

Eigen::Vector3d VirtualCoupling::force(const Eigen::Vector3d& elongation, const Eigen::Vector3d& normal,
                                       const CouplingSettings& settings, double period) CELL_RT {
  fade(settings.engage_time, period);
  const Eigen::Vector3d difference = (elongation - last_) / period;
  last_ = elongation;
  if (elongation.isZero(0)) {
    rate_.setZero();
    return Eigen::Vector3d::Zero();
  }
  rate_ += (difference - rate_) * (period / (kRateTime + period));
  Eigen::Vector3d force = share_ * (settings.stiffness * elongation + settings.damping * rate_);
  const double outwards = force.dot(normal);
  if (outwards < 0) force -= outwards * normal;
  return force;
}

}  // namespace cellmirror::haptics
