// A haptic device that gives what was recorded. For replays.
#pragma once

#include "rt_core/base/real_time.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::app {

class RecordedDevice final : public HapticDevicePort {
 public:
  HapticRead read(HapticSample& sample) CELL_RT override {
    if (outcome == HapticRead::fresh) sample = recorded;
    return outcome;
  }
  void write(const HapticOutput& /*output*/) CELL_RT override {}

  HapticRead outcome = HapticRead::unchanged;
  HapticSample recorded;
};

}  // namespace cellmirror::app
