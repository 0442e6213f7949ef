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
  rate_since_ = Timestamp();
  rate_hz_ = 0;
}

JointStreamStatus HapticStream::status() const {
  constexpr Nanoseconds kWindow{500'000'000};
  JointStreamStatus out;
  out.kind = "haptic";
  const std::scoped_lock lock(mutex_);
  out.endpoint = endpoint_;
  out.open = is_open_;
  out.condition = is_open_ ? "see haptics" : "closed";
  if (!meter_) return out;
  out.received = meter_->samples.load(std::memory_order_relaxed);
  const Timestamp now = clock_.now();
  if (!rate_since_.known() || now - rate_since_ >= kWindow) {
    if (rate_since_.known()) rate_hz_ = static_cast<double>(out.received - rate_from_) / seconds(now - rate_since_);
    rate_since_ = now;
    rate_from_ = out.received;
  }
  out.rate_hz = rate_hz_;
  return out;
}

}  // namespace cellmirror::app
