#include "rt_core/haptics/appearance.hpp"

#include <algorithm>

#include "rt_core/haptics/nearest_point.hpp"

namespace cellmirror::haptics {

double tip_depth(const ContactModel& model, const Eigen::Vector3d& x) CELL_RT {
  const NearestPoint nearest = nearest_point(model, x);
  return nearest.found ? (nearest.x - x).norm() : 0.0;
}

bool AppearanceWatch::appeared(const ContactModel& before, const ContactModel& now, const Eigen::Vector3d& x) CELL_RT {
  if (now.cell != before.cell) changed_ = now.posture_time;
  const bool placed = changed_.known() && now.posture_time <= changed_ + kAfterChange;
  const Nanoseconds between = std::clamp(now.posture_time - before.posture_time, Nanoseconds{0}, kLongestBetween);
  const double depth = tip_depth(now, x);
  const double came = depth > 0 ? std::max(0.0, depth - tip_depth(before, x)) : 0.0;
  ahead_ = std::max(0.0, ahead_ + came - (placed ? kFastestPlaced : kFastestSurface) * seconds(between));
  if (ahead_ <= kLargestStep) return false;
  ahead_ = 0;
  return true;
}

}  // namespace cellmirror::haptics
