// The fault `twice`: a second process that believes the device to be its own.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::sim {

class SecondWriter {
 public:
  SecondWriter() = default;
  ~SecondWriter() { end(); }
  SecondWriter(const SecondWriter&) = delete;
  SecondWriter& operator=(const SecondWriter&) = delete;

  // Forks a process that writes `sample`, with its own number and times, about once a period until end() or the
  // parent's end.
  void begin(std::span<std::byte> memory, const HapticSample& sample, Nanoseconds period);
  void end();
  [[nodiscard]] bool runs() const { return child_ > 0; }

 private:
  pid_t child_ = -1;
};

// The fault `torn`: leaves the device's section locked with half of a sample in it. The caller ends.
void tear(std::span<std::byte> memory);

}  // namespace cellmirror::sim
