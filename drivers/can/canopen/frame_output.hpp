// Where the frames of protocol code go.
#pragma once

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

class FrameOutput {
 public:
  virtual ~FrameOutput() = default;
  virtual void send(const CanFrame& frame) = 0;
};

}  // namespace cellmirror::can
