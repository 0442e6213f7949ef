#include "app/io/haptic_stream.hpp"

#include <utility>

namespace cellmirror::app {

Result<void> HapticStream::open(JointSampleSink& /*sink*/) {
  if (!open_) return fail("the gateway is about to end");
  if (auto opened = open_(); !opened) return opened;
  const std::scoped_lock lock(mutex_);
  is_open_ = true;
  return {};
}

void HapticStream::close() {
  if (close_) close_();
  const std::scoped_lock lock(mutex_);
  is_open_ = false;
}

void HapticStream::detach() {
  open_ = {};
  close_ = {};
}

void HapticStream::set_memory(std::string endpoint, std::shared_ptr<const HapticMeter> meter) {
  const std::scoped_lock lock(mutex_);
  endpoint_ = std::move(endpoint);
  meter_ = std::move(meter);
}

JointStreamStatus HapticStream::status() const {
  JointStreamStatus out;
  out.kind = "haptic";
  const std::scoped_lock lock(mutex_);
  out.endpoint = endpoint_;
  out.open = is_open_;
  out.condition = is_open_ ? "see haptics" : "closed";
  if (!meter_) return out;
  out.received = meter_->samples.load(std::memory_order_relaxed);
  if (is_open_) out.rate_hz = static_cast<double>(meter_->samples_per_second.load(std::memory_order_relaxed));
  return out;
}

}  // namespace cellmirror::app
