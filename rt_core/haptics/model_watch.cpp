#include "rt_core/haptics/model_watch.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/haptics/bounds.hpp"
#include "rt_core/haptics/instrument_map.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::haptics {

namespace {

constexpr double kSameTip = 1e-4;  // m: what a base that creeps may come between an instrument and a model

bool sensible(const ContactModel& model) CELL_RT {
  constexpr double kLongestNormal = 1e3;
  if (model.count > kMaxConstraints || !is_bounded(model.x_ref, kFarthestPlace) || !std::isfinite(model.reach))
    return false;
  for (std::size_t i = 0; i < model.count; ++i) {
    const ContactConstraint& constraint = model.constraints[i];
    if (!is_bounded(constraint.a, kLongestNormal) || !(std::abs(constraint.gap) <= kFarthestPlace) ||
        !is_bounded(constraint.normal, kLongestNormal) || !is_bounded(constraint.point, kFarthestPlace)) {
      return false;
    }
  }
  return true;
}

bool belongs_to(const ContactModel& model, const Instrument& instrument) CELL_RT {
  if (model.joint_count == 0) return true;
  if (model.joint_count != instrument.joint_count) return false;
  const Pose X_WE = instrument.X_WB * kinematics::forward(instrument.chain, chain_values(instrument, model.q));
  return (X_WE.translation() - model.x_ref).norm() <= kSameTip;
}

}  // namespace

void ModelWatch::restart() CELL_RT {
  known_ = false;
  appeared_ = false;
  appearance_.restart();
}

void ModelWatch::update(const ContactModel* newest, const Instrument& instrument, const Eigen::Vector3d& x) CELL_RT {
  appeared_ = false;
  if (newest == nullptr || newest->sequence == 0 || newest->slot != instrument.slot) return;
  if (known_ && newest->sequence == model_.sequence && newest->posture_time == model_.posture_time) return;
  if (!sensible(*newest) || !belongs_to(*newest, instrument)) return;
  ContactModel taken = *newest;
  for (std::size_t i = 0; !taken.certain && i < taken.count; ++i) {
    taken.constraints[i].gap = std::min(taken.constraints[i].gap, 0.0);
  }
  appeared_ = known_ && appearance_.appeared(model_, taken, x);
  model_ = taken;
  known_ = true;
}

bool ModelWatch::stale(Timestamp now, Nanoseconds stale_after) const CELL_RT {
  return known_ && now - model_.posture_time > stale_after;
}

}  // namespace cellmirror::haptics
