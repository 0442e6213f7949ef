// A haptic device as the stream of its instrument's robot, for ROBOT ... online and for status. The samples themselves
// arise in the tick.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "app/snapshot/haptic_meter.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::app {

class HapticStream final : public JointStream {
 public:
  // `open` and `close` the robot's channel.
  HapticStream(std::function<Result<void>()> open, std::function<void()> close)
      : open_(std::move(open)), close_(std::move(close)) {}

  Result<void> open(JointSampleSink& sink) override;
  void close() override;
  [[nodiscard]] JointStreamStatus status() const override;

  // The owner of open() and close() ends.
  void detach();
  // The memory that the device's process shares with us now.
  void set_memory(std::string endpoint, std::shared_ptr<const HapticMeter> meter);

 private:
  std::function<Result<void>()> open_;
  std::function<void()> close_;
  mutable std::mutex mutex_;  // of what follows: status() comes from other threads
  bool is_open_ = false;
  std::string endpoint_ = "no shared memory";
  std::shared_ptr<const HapticMeter> meter_;
};

}  // namespace cellmirror::app
