// Velocities or efforts of a robot's joints, which may stop to come while the positions go on.
#pragma once

#include <array>
#include <cstddef>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::can {

class TimedValues {
 public:
  using Values = std::array<double, kMaxJointsPerRobot>;

  void set(std::size_t joint, double value, Timestamp now) {
    values_[joint] = value;
    received_[joint] = now;
  }
  // The newest value was refused.
  void forget(std::size_t joint) { received_[joint] = {}; }

  // Zero for joints of which none came within `longest` before `now`.
  [[nodiscard]] Values at(Timestamp now, Nanoseconds longest) const {
    Values out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (received_[i].known() && now - received_[i] <= longest) out[i] = values_[i];
    }
    return out;
  }

 private:
  Values values_{};
  std::array<Timestamp, kMaxJointsPerRobot> received_{};
};

}  // namespace cellmirror::can
