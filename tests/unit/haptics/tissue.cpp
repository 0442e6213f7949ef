#include "tissue.hpp"

#include <algorithm>

namespace cellmirror::haptics::test_rig {

namespace {

using Eigen::Vector3d;

constexpr double kTipRadius = 4e-3;  // m
constexpr double kPoissonsRatio = 0.45;

}  // namespace

double stiffness_of_tissue(double youngs_modulus_pa) {
  return 2 * youngs_modulus_pa * kTipRadius / (1 - kPoissonsRatio * kPoissonsRatio);
}

TissueForce StandInTissue::response(const Rig& rig) {
  const double t = static_cast<double>(ticks_) * seconds(rig.period);
  const Vector3d x = rig.state().x_proxy;
  const Vector3d v = known_ ? Vector3d((x - before_) / seconds(rig.period)) : Vector3d::Zero();
  before_ = x;
  known_ = true;
  TissueForce out;
  out.posture_time = rig.now;
  out.slot = rig.instrument.slot;
  out.x_ref = x;
  if (t >= parameters_.removed_at) return out;
  const bool holds = t >= parameters_.grips_at && t < parameters_.releases_at;
  // What is gripped while it is pressed keeps its pressure.
  if (holds && !held_) anchor_ = x - Vector3d(0, 0, std::min(x.z(), 0.0));
  held_ = holds;
  if (held_) {
    out.held = 1;
    out.force_W = parameters_.stiffness * (anchor_ - x) - parameters_.damping * v;
    out.stiffness = parameters_.stiffness * Eigen::Matrix3d::Identity();
  } else if (x.z() < 0) {
    out.contacts = 1;
    out.force_W.z() = std::max(0.0, -parameters_.stiffness * x.z() - parameters_.damping * v.z());
    out.stiffness(2, 2) = parameters_.stiffness;
  }
  if (!parameters_.local_stiffness) out.stiffness.setZero();
  return out;
}

void StandInTissue::smooth(TissueForce& response) {
  if (parameters_.smoothing >= 1) return;
  if (smoothed_.force_W.isZero(0)) smoothed_.x_ref = response.x_ref;
  smoothed_.force_W += parameters_.smoothing * (response.force_W - smoothed_.force_W);
  smoothed_.x_ref += parameters_.smoothing * (response.x_ref - smoothed_.x_ref);
  if (response.contacts == 0 && response.held == 0) {
    smoothed_ = TissueForce();
    return;
  }
  response.force_W = smoothed_.force_W;
  if (parameters_.smooths_place) response.x_ref = smoothed_.x_ref;
}

void StandInTissue::operator()(Rig& rig) {
  if (rig.state().phase == HapticPhase::waiting) return;
  TissueForce made = response(rig);
  smooth(made);
  const double t = static_cast<double>(ticks_) * seconds(rig.period);
  if (ticks_ % static_cast<std::uint64_t>(parameters_.every) == 0 && t < parameters_.stops_at) {
    made.sequence = ++sequence_;
    under_way_.push_back(made);
  }
  ++ticks_;
  const Nanoseconds delay{rig.period.count() * (parameters_.delay - 1)};
  while (!under_way_.empty() && rig.now - under_way_.front().posture_time >= delay) {
    rig.tissue = under_way_.front();
    rig.show_tissue = true;
    under_way_.pop_front();
  }
}

}  // namespace cellmirror::haptics::test_rig
