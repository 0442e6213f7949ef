// Who is given what a stream received, byte by byte as it came, before anything is taken from it: a recording.
#pragma once

#include <cstddef>
#include <span>

#include "rt_core/base/time.hpp"

namespace cellmirror {

class PayloadSink {
 public:
  virtual ~PayloadSink() = default;
  // Called by one thread at a time, the one that received it. Does not wait.
  virtual void take(std::span<const std::byte> payload, Timestamp receive_time) = 0;
};

}  // namespace cellmirror
