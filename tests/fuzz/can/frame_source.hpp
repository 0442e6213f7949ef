// Frames and pauses out of fuzz bytes. A record: two bytes identifier and flags, one byte length and kind, one byte
// pause in milliseconds, then the data.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror {

class FrameSource {
 public:
  FrameSource(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  // Moves `now` on by the record's pause.
  std::optional<CanFrame> next(Timestamp& now) {
    if (left_.size() < 4) return {};
    CanFrame frame;
    frame.id = static_cast<std::uint32_t>(left_[0] | (left_[1] & 0x07) << 8);
    frame.extended = (left_[1] & 0x80) != 0;
    frame.remote = (left_[1] & 0x40) != 0;
    frame.error = (left_[1] & 0x20) != 0;
    frame.fd = (left_[2] & 0x80) != 0;
    frame.length = static_cast<std::uint8_t>((left_[2] & 0x7F) % (frame.fd ? 65 : 9));
    now = now + std::chrono::milliseconds(left_[3]);
    left_ = left_.subspan(4);
    for (std::size_t i = 0; i < frame.length && !left_.empty(); ++i) {
      frame.data[i] = left_.front();
      left_ = left_.subspan(1);
    }
    return frame;
  }

 private:
  std::span<const std::uint8_t> left_;
};

}  // namespace cellmirror
