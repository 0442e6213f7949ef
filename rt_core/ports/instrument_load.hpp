// Loads of soft tissue on the instruments that act on it, however these are moved: plain data from the simulation of
// tissue to all outputs of forces. SI units.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror {

struct InstrumentLoad {
  std::uint8_t slot = 0;                               // of the robot
  Eigen::Vector3d force_T = Eigen::Vector3d::Zero();   // N, of the tissue on the instrument, in the frame of the TCP
  Eigen::Vector3d torque_T = Eigen::Vector3d::Zero();  // Nm, about the TCP, in its frame
  std::uint32_t contacts = 0;
};

struct InstrumentLoads {
  // An older load is not used, because the simulation has stalled.
  static constexpr Nanoseconds kExpires{250'000'000};

  Timestamp posture_time;  // time of the tick whose posture they belong to
  std::vector<InstrumentLoad> loads;

  // Returns null if no load of the robot is known at `now`.
  [[nodiscard]] const InstrumentLoad* find(std::size_t slot, Timestamp now) const {
    if (now - posture_time > kExpires) return nullptr;
    for (const InstrumentLoad& load : loads) {
      if (load.slot == slot) return &load;
    }
    return nullptr;
  }
};

}  // namespace cellmirror
