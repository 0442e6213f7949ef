// Where a CANopen node of a protocol sends its frames: into the channel of its stream. The channel's thread.
#pragma once

#include <cstddef>

#include "drivers/can/canopen/frame_output.hpp"
#include "drivers/can/stream/can_protocol.hpp"

namespace cellmirror::can {

class NodeOutput final : public FrameOutput {
 public:
  // `node`: its number in the protocol, from 0. `host` outlives this.
  NodeOutput(CanProtocolHost& host, std::size_t node) : host_(&host), node_(node) {}

  void send(const CanFrame& frame) override { host_->send_from(node_, frame); }

 private:
  CanProtocolHost* host_;
  std::size_t node_;
};

}  // namespace cellmirror::can
