// Where the CANopen nodes of a protocol send their frames: into the stream's channel. The stream's thread.
#pragma once

#include <cstdint>

#include "drivers/can/canopen/frame_output.hpp"
#include "drivers/can/stream/can_stream.hpp"

namespace cellmirror::can {

class CountedOutput final : public FrameOutput {
 public:
  explicit CountedOutput(CanProtocolHost& host) : host_(&host) {}  // outlives this

  void send(const CanFrame& frame) override {
    if (!host_->send(frame)) ++refused_;
  }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }  // frames that the channel did not take

 private:
  CanProtocolHost* host_;
  std::uint64_t refused_ = 0;
};

}  // namespace cellmirror::can
