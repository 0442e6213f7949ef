// Where a robot touches something, in coordinates of its joints. Plain data: the collision tests fill it, the
// drives of a simulated machine read it.
#pragma once

#include <array>
#include <cstddef>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// Of one contact, by joint: how fast its depth grows where the joint moves in its positive direction [m/rad or m/m].
// Zero: the joint does not move the bodies against each other along the contact's normal.
using DepthRates = std::array<double, kMaxJointsPerRobot>;

struct RobotContacts {
  static constexpr std::size_t kMost = 8;

  Timestamp posture_time;  // the tick's instant
  std::size_t count = 0;
  std::array<DepthRates, kMost> rates{};  // the first `count`; of more contacts the deepest
};

}  // namespace cellmirror
