// Spreads the poses of a stream over the steps of a faster simulation: a robot that is mirrored 125 times a second
// would else stand still for seven steps and jump in the eighth.
#pragma once

#include <cstdint>

#include "rt_core/base/pose.hpp"

namespace cellmirror::app {

// Follows behind the stream by one of its periods; nothing is extrapolated. A stream with a new pose in each step
// passes through unchanged. No heap memory. One thread.
class PoseRamp {
 public:
  // Once a step, with the newest pose. A pose that is not finite passes through.
  Pose step(const Pose& newest);

 private:
  static constexpr std::uint32_t kLongestPeriod = 40;  // steps; longer is a rest

  bool known_ = false;
  Pose target_ = Pose::Identity();
  Pose now_ = Pose::Identity();
  std::uint32_t period_ = 1;  // steps between the newest two changes that were no rest
  std::uint32_t since_ = 0;   // steps since the newest change
  std::uint32_t left_ = 0;    // steps until `now_` is at the target
};

}  // namespace cellmirror::app
