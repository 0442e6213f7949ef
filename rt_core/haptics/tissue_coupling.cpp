#include "rt_core/haptics/tissue_coupling.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "rt_core/haptics/bounds.hpp"

namespace cellmirror::haptics {

namespace {

constexpr double kLargestForce = 1e3;       // N: tears any tissue, and any instrument from the hand
constexpr double kLargestTorque = 100.0;    // Nm
constexpr double kStiffest = 1e6;           // N/m
constexpr double kRounding = 1e-6;          // share of the largest stiffness
constexpr double kNoForce = 1e-6;           // N
constexpr Eigen::Index kPlacedByThree = 4;  // variables: three that place the tip, and the roll
// N/m, 2 E r / (1 - v^2) of a flat tip with r = 2 mm in tissue of E = 1 kPa. What resists less counts as if it resisted
// so much: without a bound all work of friction and of lifting would count as stored.
constexpr double kSoftest = 5.0;
// s: responses that come in every tick, or miss one, need no smoothing.
constexpr double kSmoothUpTo = 20e-3;
constexpr double kSmoothKept = 0.9;  // from one response to the next: what comes after a pause arrives smoothly too
constexpr double kLagHeld = 0.5;     // s, of the decay of the largest age

// An upper bound of the largest eigenvalue of a symmetric matrix, exact for one plane and for equal eigenvalues.
double steepness_of(const Eigen::Matrix3d& K) CELL_RT {
  return std::min(K.cwiseAbs().rowwise().sum().maxCoeff(), K.norm());
}

// By its principal minors, up to rounding.
bool is_stiffness(const Eigen::Matrix3d& K) CELL_RT {
  if (!K.allFinite()) return false;
  const double largest = K.cwiseAbs().maxCoeff();
  if (largest > kStiffest) return false;
  if (largest == 0) return true;
  const Eigen::Matrix3d k = K / largest;
  if ((k - k.transpose()).cwiseAbs().maxCoeff() > kRounding) return false;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (k(i, i) < -kRounding || k(i, i) * k(j, j) - k(i, j) * k(j, i) < -kRounding) return false;
  }
  return k.determinant() >= -kRounding;
}

bool sensible(const TissueForce& response) CELL_RT {
  return response.posture_time.known() && is_bounded(response.x_ref, kFarthestPlace) &&
         is_bounded(response.force_W, kLargestForce) && is_bounded(response.torque_W, kLargestTorque) &&
         is_stiffness(response.stiffness);
}

double nearness(double distance) CELL_RT {
  return std::clamp((kTissueElsewhere - distance) / (kTissueElsewhere - kTissueDistant), 0.0, 1.0);
}

// Nothing is held: a force against the direction in which the tissue pushes would pull the tip into it. With the push
// the force across it vanishes too, so that nothing is left when the tip has come off.
Eigen::Vector3d pushing_only(const Eigen::Vector3d& force, const Eigen::Vector3d& at_reference) CELL_RT {
  const double size = at_reference.norm();
  if (!(size > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d outwards = at_reference / size;
  const double push = force.dot(outwards);
  const Eigen::Vector3d across = force - push * outwards;
  return std::max(push, 0.0) * outwards + std::clamp(push / size, 0.0, 1.0) * across;
}

}  // namespace

// The power of a torque is that of a force at the tip, as far as the tool turns when the tip moves: turning^T torque.
TissueTip tissue_tip(const TipPosture& tip, const Pose& X_WB) CELL_RT {
  TissueTip out;
  const Eigen::Matrix3d R_WB = X_WB.linear();
  out.x = X_WB * tip.X_BE.translation();
  out.axis = R_WB * tip.X_BE.linear().col(2);
  if (tip.J.cols() > kPlacedByThree) return out;
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();  // sums over joints of J_v J_v^T and of J_w J_v^T
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < tip.J.cols(); ++i) {
    const Eigen::Vector3d v = tip.J.col(i).head<3>();
    const Eigen::Vector3d w = tip.J.col(i).tail<3>();
    across += v * v.transpose();
    turned += w * v.transpose();
  }
  across.diagonal().array() += kPlaceDamping;
  const Eigen::Matrix3d turning_B = turned * across.inverse();
  out.turning = R_WB * turning_B * R_WB.transpose();
  return out;
}

void TissueCoupling::restart() CELL_RT {
  const std::uint64_t late = late_;
  const std::uint64_t refused = refused_;
  *this = TissueCoupling{};
  late_ = late;
  refused_ = refused;
}

void TissueCoupling::release() CELL_RT {
  correction_.setZero();
  last_.setZero();
  last_torque_ = 0;
}

void TissueCoupling::accept(const TissueForce& response, Timestamp now) CELL_RT {
  const double between = known_ ? std::min(seconds(now - taken_), kSmoothUpTo) : 0.0;
  smoothing_ = std::max(between, kSmoothKept * smoothing_);
  force_ = response;
  force_.stiffness = 0.5 * (response.stiffness + response.stiffness.transpose());
  steepness_ = steepness_of(force_.stiffness);
  taken_ = now;
  known_ = true;
  fresh_ = true;
  counted_late_ = false;
}

void TissueCoupling::take(const TissueForce* newest, std::uint8_t slot, Timestamp now, double period) CELL_RT {
  const bool concerns = newest != nullptr && newest->sequence != 0 && newest->slot == slot;
  if (concerns && (newest->sequence != seen_ || newest->posture_time != seen_time_)) {
    seen_ = newest->sequence;
    seen_time_ = newest->posture_time;
    const bool in_order = newest->posture_time <= now && (!known_ || newest->posture_time >= force_.posture_time);
    if (in_order && sensible(*newest)) {
      accept(*newest, now);
    } else {
      ++refused_;
    }
  }
  if (!known_) return;
  const Nanoseconds age = now - force_.posture_time;
  if (age > kTissueLate && !counted_late_) {
    counted_late_ = true;
    ++late_;
  }
  const double step = period / seconds(kTissueFade);
  const double old = seconds(age);
  lag_ += (old - lag_) * (old > lag_ ? 1.0 : period / (kLagHeld + period));
  share_ = std::clamp(age <= kTissueExpires ? share_ + step : share_ - step, 0.0, 1.0);
}

// What a new response changes at this place is let through over a time, so that a worker that is slow gives no steps.
Eigen::Vector3d TissueCoupling::smoothed(const Eigen::Vector3d& force, double period) CELL_RT {
  const double time = 0.5 * std::max(smoothing_ - 2 * period, 0.0);
  if (fresh_) correction_ = last_ - force;
  fresh_ = false;
  correction_ *= time / (time + period);
  if (correction_.norm() < kNoForce) correction_.setZero();
  return force + correction_;
}

// A spring that answers late gives energy: as much the stiffer it is, and the later. What is soft stays as it is.
double TissueCoupling::softening(double stiffest) const CELL_RT {
  const double late = seconds(kTissueLate);
  const double bearable = lag_ > late ? stiffest * late / lag_ : stiffest;
  return steepness_ > bearable ? bearable / steepness_ : 1.0;
}

TissueReaction TissueCoupling::react(const TissueTip& tip, const TissueLimits& limits, double share,
                                     double period) CELL_RT {
  TissueReaction out;
  if (!known_) return out;
  const Eigen::Vector3d way = tip.x - force_.x_ref;
  const double distance = way.norm();
  const double softened = softening(limits.stiffness);
  const double felt = share * share_ * softened * nearness(distance);
  const Eigen::Matrix3d stiffness = felt * force_.stiffness;
  const double axis_torque = force_.torque_W.dot(tip.axis);
  const Eigen::Vector3d at_reference =
      felt * (force_.force_W + tip.turning.transpose() * (force_.torque_W - axis_torque * tip.axis));
  const double kept = distance > kTissueReach ? kTissueReach / distance : 1.0;
  const bool acts = force_.held > 0 || !at_reference.isZero(0);
  Eigen::Vector3d force = acts ? Eigen::Vector3d(at_reference - stiffness * (kept * way)) : Eigen::Vector3d::Zero();
  force = smoothed(force, period);
  // Without a force of its own there is only what is left of the last response.
  if (force_.held == 0 && !at_reference.isZero(0)) force = pushing_only(force, at_reference);
  last_ = force;
  out.force_W = force;

  const double torque = std::clamp(felt * axis_torque, -limits.torque, limits.torque);
  const double turn = limits.torque_rate * period;
  last_torque_ = std::clamp(torque, last_torque_ - turn, last_torque_ + turn);
  out.axis_torque = last_torque_;

  // Twice what a spring with this stiffness stores: tissue that becomes stiffer the deeper it is pressed (force as a
  // power of the depth) has stored less than that and more than the spring.
  Eigen::Matrix3d resisting = stiffness;
  resisting.diagonal().array() += kSoftest;
  out.stored = force.dot(resisting.inverse() * force);
  return out;
}

}  // namespace cellmirror::haptics
