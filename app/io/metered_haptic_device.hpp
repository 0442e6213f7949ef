// A haptic device whose latency and rate are measured.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "app/snapshot/haptic_meter.hpp"
#include "drivers/haptic/shared_memory_device.hpp"
#include "rt_core/base/rate_meter.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::app {

class MeteredDevice final : public HapticDevicePort {
 public:
  // `memory` and `clock` outlive it; `joints`: of the instrument's robot, `process`: our own.
  MeteredDevice(std::span<std::byte> memory, std::uint8_t joints, std::uint32_t process, const Clock& clock,
                std::shared_ptr<HapticMeter> meter)
      : device_(memory, joints, process), clock_(clock), meter_(std::move(meter)) {}

  HapticRead read(HapticSample& sample) CELL_RT override {
    const HapticRead outcome = device_.read(sample);
    const Timestamp now = clock_.now();
    if (outcome == HapticRead::fresh) {
      measured_ = sample.time;
      unanswered_ = true;
      rate_.count(now);
      // Only the tick writes it.
      meter_->samples.store(meter_->samples.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
    meter_->samples_per_second.store(static_cast<std::uint64_t>(rate_.per_second(now)), std::memory_order_relaxed);
    return outcome;
  }

  void write(const HapticOutput& output) CELL_RT override {
    device_.write(output);
    if (!unanswered_) return;
    unanswered_ = false;
    meter_->latency.record(clock_.now() - measured_);
  }

 private:
  haptic::SharedMemoryDevice device_;
  const Clock& clock_;
  std::shared_ptr<HapticMeter> meter_;
  Timestamp measured_;
  RateMeter rate_;
  bool unanswered_ = false;
};

}  // namespace cellmirror::app
