// Ends the program where a node sends what is no frame of classic CAN with 11 bits.
#pragma once

#include <cstdlib>

#include "drivers/can/canopen/frame_output.hpp"

namespace cellmirror {

struct CheckedOutput : can::FrameOutput {
  void send(const CanFrame& frame) override {
    if (frame.length > 8 || frame.id > 0x7FF) std::abort();
  }
};

}  // namespace cellmirror
