#include "app/workers/pose_ramp.hpp"

#include <Eigen/Geometry>

namespace cellmirror::app {

Pose PoseRamp::step(const Pose& newest) {
  if (!newest.matrix().allFinite()) {
    known_ = false;
    return newest;
  }
  if (!known_) {
    known_ = true;
    target_ = now_ = newest;
    since_ = left_ = 0;
    return now_;
  }
  ++since_;
  if (!(newest.matrix().array() == target_.matrix().array()).all()) {
    if (since_ <= kLongestPeriod) period_ = since_;
    target_ = newest;
    since_ = 0;
    left_ = period_;
  }
  if (left_ <= 1) {
    left_ = 0;
    now_ = target_;
    return now_;
  }
  const double share = 1.0 / static_cast<double>(left_--);
  const Eigen::Quaterniond from(now_.linear());
  now_.linear() = from.slerp(share, Eigen::Quaterniond(target_.linear())).toRotationMatrix();
  now_.translation() += share * (target_.translation() - now_.translation());
  return now_;
}

}  // namespace cellmirror::app
