#include "drivers/haptic/shared_memory_device.hpp"

#include "ipc/wire/haptic_block.hpp"

namespace cellmirror::haptic {

SharedMemoryDevice::SharedMemoryDevice(std::span<std::byte> memory, std::uint8_t joint_count, std::uint32_t process)
    : memory_(memory), process_(process), joint_count_(joint_count) {
  prepare_haptic_block(memory_, joint_count_, process_);
}

SharedMemoryDevice::~SharedMemoryDevice() { end_haptic_block(memory_); }

HapticRead SharedMemoryDevice::read(HapticSample& sample) CELL_RT {
  return read_haptic_sample(memory_, last_lock_, sample);
}

void SharedMemoryDevice::write(const HapticOutput& output) CELL_RT {
  if (restore_haptic_header(memory_, joint_count_, process_)) ++headers_restored_;
  write_haptic_output(memory_, output);
}

}  // namespace cellmirror::haptic
