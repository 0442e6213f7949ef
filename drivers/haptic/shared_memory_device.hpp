// A haptic device whose process shares memory with the gateway.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::haptic {

// `memory` outlives it (ipc/wire/haptic_block.hpp says what is in it).
class SharedMemoryDevice final : public HapticDevicePort {
 public:
  explicit SharedMemoryDevice(std::span<std::byte> memory) : memory_(memory) {}
  HapticRead read(HapticSample& sample) CELL_RT override;
  void write(const HapticOutput& output) CELL_RT override;

 private:
  std::span<std::byte> memory_;
  std::uint64_t last_lock_ = 0;
};

}  // namespace cellmirror::haptic
