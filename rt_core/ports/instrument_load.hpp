// What soft tissue does to the instruments that act on it, however they are moved: plain data from the simulation of
// tissue to everything that tells of forces. SI.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror {

struct InstrumentLoad {
  std::uint8_t slot = 0;                               // of the robot
  Eigen::Vector3d force_T = Eigen::Vector3d::Zero();   // N, of the tissue on the instrument, in the frame of the TCP
  Eigen::Vector3d torque_T = Eigen::Vector3d::Zero();  // Nm, of the same about the TCP
  std::uint32_t contacts = 0;
};

struct InstrumentLoads {
  // An older load is not used: the simulation has stalled.
  static constexpr Nanoseconds kExpires{250'000'000};

  Timestamp posture_time;  // of the tick for whose posture they were computed
  std::vector<InstrumentLoad> loads;

  // Null: none is known of it at `now`.
  [[nodiscard]] const InstrumentLoad* find(std::size_t slot, Timestamp now) const {
    if (now - posture_time > kExpires) return nullptr;
    for (const InstrumentLoad& load : loads) {
      if (load.slot == slot) return &load;
    }
    return nullptr;
  }
};

}  // namespace cellmirror
