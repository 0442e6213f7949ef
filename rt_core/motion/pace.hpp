// Rate of time on a path: 1, or less while a robot is held. Real-time class: any.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::motion {

// What a move makes up for of what it began late, at most; and how much harder it accelerates for that.
inline constexpr double kMostCatchUp = 0.05;  // s
inline constexpr double kHardestCatchUp = 1.25;

// The bounds of the change of the pace, 1/s: `least` is not positive, `most` not negative.
struct PaceChange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  // Where time goes at the pace p, something with the velocity v and the acceleration a on its path has the velocity
  // p v and the acceleration p^2 a + p' v. That stays within `limit`, or what the path itself takes where that is more
  // (a sine). So a path that brakes already is not braked more: it comes to its end.
  void bound(double velocity, double acceleration, double limit, double pace) CELL_RT {
    if (velocity == 0) return;
    const double most_of_all = std::max(limit, std::abs(acceleration));
    const double taken = std::copysign(pace * pace * acceleration, velocity * acceleration);
    least = std::max(least, std::min(-(most_of_all + taken) / std::abs(velocity), 0.0));
    most = std::min(most, std::max((most_of_all - taken) / std::abs(velocity), 0.0));
  }
};

}  // namespace cellmirror::motion
