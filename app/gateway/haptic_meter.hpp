// A haptic device with a watch beside it: how long from the device's measurement to the force that answers it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "drivers/haptic/shared_memory_device.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// Written by the tick, read by anybody.
struct HapticMeter {
  LatencyHistogram latency;               // device's time of a sample to its force in the memory
  std::atomic<std::uint64_t> samples{0};  // relaxed: a number for people
};

class MeteredDevice final : public HapticDevicePort {
 public:
  // `memory` and `clock` outlive it; `joints`: of the instrument's robot, `process`: our own.
  MeteredDevice(std::span<std::byte> memory, std::uint8_t joints, std::uint32_t process, const Clock& clock,
                std::shared_ptr<HapticMeter> meter)
      : device_(memory, joints, process), clock_(clock), meter_(std::move(meter)) {}

  HapticRead read(HapticSample& sample) CELL_RT override {
    const HapticRead outcome = device_.read(sample);
    if (outcome == HapticRead::fresh) {
      measured_ = sample.time;
      unanswered_ = true;
      // Only the tick writes it.
      meter_->samples.store(meter_->samples.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
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
  bool unanswered_ = false;
};

}  // namespace cellmirror::app
