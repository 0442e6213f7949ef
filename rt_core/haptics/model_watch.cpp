#include "rt_core/haptics/model_watch.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::haptics {

namespace {

constexpr double kFarthest = 1e4;  // m: no place of a cell is farther away

bool bounded(const Eigen::Vector3d& v, double most) CELL_RT { return v.allFinite() && v.cwiseAbs().maxCoeff() <= most; }

bool sensible(const ContactModel& model) CELL_RT {
  constexpr double kLongestNormal = 1e3;
  if (model.count > kMaxConstraints || !bounded(model.x_ref, kFarthest) || !std::isfinite(model.reach)) return false;
  for (std::size_t i = 0; i < model.count; ++i) {
    const ContactConstraint& constraint = model.constraints[i];
    if (!bounded(constraint.a, kLongestNormal) || !(std::abs(constraint.gap) <= kFarthest) ||
        !bounded(constraint.normal, kLongestNormal) || !bounded(constraint.point, kFarthest)) {
      return false;
    }
  }
  return true;
}

}  // namespace

void ModelWatch::look_at(const ContactModel* newest, std::uint8_t slot) CELL_RT {
  if (newest == nullptr || newest->sequence == 0 || newest->slot != slot) return;
  if (known_ && newest->sequence == model_.sequence && newest->posture_time == model_.posture_time) return;
  if (!sensible(*newest)) return;
  model_ = *newest;
  known_ = true;
  if (model_.certain) return;
  for (std::size_t i = 0; i < model_.count; ++i) model_.constraints[i].gap = std::min(model_.constraints[i].gap, 0.0);
}

bool ModelWatch::stale(Timestamp now, Nanoseconds stale_after) const CELL_RT {
  return known_ && now - model_.posture_time > stale_after;
}

}  // namespace cellmirror::haptics
