// Makes the vtables of classes that are defined in headers only, for tests/support/tick_calls.py. Never linked.
#include <memory>

#include "app/io/metered_haptic_device.hpp"

namespace cellmirror::app {

std::unique_ptr<HapticDevicePort> metered_device(std::span<std::byte> memory, const Clock& clock,
                                                 std::shared_ptr<HapticMeter> meter) {
  return std::make_unique<MeteredDevice>(memory, std::uint8_t{6}, 1U, clock, std::move(meter));
}

}  // namespace cellmirror::app
