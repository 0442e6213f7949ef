// What tests/support/tick_calls.py has to find behind a virtual call of the tick. Never linked.
#include <unistd.h>

#include <functional>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::planted {

class Device final : public HapticDevicePort {
 public:
  HapticRead read(HapticSample& sample) CELL_RT override {
    const std::lock_guard lock(mutex_);
    times_.push_back(sample.time);
    return HapticRead::none;
  }
  void write(const HapticOutput& /*output*/) CELL_RT override {
    answer_();
    if (::write(STDOUT_FILENO, "", 1) != 1) fail();
    asm volatile("syscall" : : "a"(39) : "rcx", "r11", "memory");
  }

 private:
  [[gnu::noinline]] static void fail() { throw std::runtime_error("thrown"); }

  std::mutex mutex_;
  std::vector<Timestamp> times_;
  std::function<void()> answer_;
};

HapticDevicePort* make() { return new Device; }

}  // namespace cellmirror::planted
