// A haptic device whose process shares memory with the gateway.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::haptic {

// The gateway's end of a block of memory (layout: ipc/wire/haptic_block.hpp). read() and write() belong to one thread,
// the tick: loads and stores in mapped memory, no system call; all pages of `memory` are present (SharedSegment ensures
// it), so that no access faults.
class SharedMemoryDevice final : public HapticDevicePort {
 public:
  // Writes the header and zero forces. `memory` is aligned to 8 bytes and outlives this; `joint_count` is that of the
  // instrument's robot; `process` the gateway's process number. Not for the tick.
  SharedMemoryDevice(std::span<std::byte> memory, std::uint8_t joint_count, std::uint32_t process);
  // Writes zero forces and marks the end of writing for the device. The tick no longer uses it.
  ~SharedMemoryDevice() override;
  SharedMemoryDevice(const SharedMemoryDevice&) = delete;
  SharedMemoryDevice& operator=(const SharedMemoryDevice&) = delete;

  // The newest sample, where another one has been written since the last call that gave `fresh`: whatever the device's
  // process wrote, by value (read_haptic_sample()). Tick.
  HapticRead read(HapticSample& sample) CELL_RT override;
  // Forces that are not finite become zero (write_haptic_output()). Rewrites a missing header, as after
  // SharedSegment::renew(). Tick.
  void write(const HapticOutput& output) CELL_RT override;

  // How often the header was no longer there. The tick's thread.
  [[nodiscard]] std::uint64_t headers_restored() const CELL_RT { return headers_restored_; }

 private:
  std::span<std::byte> memory_;
  std::uint64_t last_lock_ = 0;
  std::uint64_t headers_restored_ = 0;
  std::uint32_t process_;
  std::uint8_t joint_count_;
};

}  // namespace cellmirror::haptic
