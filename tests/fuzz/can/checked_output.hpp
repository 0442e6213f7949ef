// Ends the program where a node sends what is no frame of classic CAN with 11 bits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "drivers/can/canopen/frame_output.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror {

struct CheckedOutput : can::FrameOutput {
  void send(const CanFrame& frame) override {
    if (frame.length > 8 || frame.id > 0x7FF) std::abort();
    ++sent;
  }
  std::size_t sent = 0;
};

// Gives the node a frame. Ends the program where it answers one that it does not list.
template <class Node>
void receive_checked(Node& node, const CheckedOutput& output, const CanFrame& frame, Timestamp now) {
  std::vector<std::uint32_t> listed;
  node.list_identifiers(listed);
  const bool takes = !frame.extended && std::ranges::find(listed, frame.id) != listed.end();
  node.advance(now);  // what is due without the frame
  const std::size_t before = output.sent;
  node.receive(frame, now);
  if (!takes && output.sent != before) std::abort();
}

}  // namespace cellmirror
