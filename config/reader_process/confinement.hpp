// What a program that reads files for the gateway takes from itself, so that a damaged or hostile file can do no more
// than end it. Linux.
#pragma once

#include <cstdint>

namespace cellmirror {

struct Confinement {
  std::uint64_t address_space_bytes = std::uint64_t{3} << 30U;
  std::uint64_t processor_seconds = 60;  // then it ends with SIGXCPU
};

// Closes all descriptors but 0, 1 and 2; bounds memory, processor time, files; forbids all system calls but those that
// reading, writing and memory take. The process ends with the thread that started it. What a kernel does not have is
// left out. With sanitizers memory, new descriptors and system calls stay free: they need them.
void confine_this_process(const Confinement& limits);

}  // namespace cellmirror
