// A haptic device as the other threads see it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/snapshot/haptic_meter.hpp"
#include "rt_core/haptics/haptic_channel.hpp"

namespace cellmirror::app {

struct HapticSnapshot {
  std::string robot;
  std::uint8_t slot = 0;
  std::uint8_t channel = 0;  // in the tick
  bool online = false;
  double reach_m = 0;
  haptics::HapticSettings settings;
  std::optional<std::int32_t> key;  // of its memory; none: it has none yet
  std::size_t bytes = 0;
  std::uint64_t attached = 0;  // processes that share it, ourselves included
  std::uint64_t renewed = 0;   // times that the memory was removed and created again
  bool device_gone = false;
  std::shared_ptr<const HapticMeter> meter;
};

}  // namespace cellmirror::app
