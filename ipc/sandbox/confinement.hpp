// What a program that reads bytes of strangers for the gateway takes from itself, so that a damaged file or a hostile
// datagram can do no more than end it. Called by that program. Linux; what a kernel does not have is left out. With
// sanitizers memory, new descriptors and system calls stay free: their run time needs them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace cellmirror {

// The exit status of a program that ran out of the memory that it may have.
inline constexpr int kOutOfMemoryStatus = 71;

struct Confinement {
  std::uint64_t address_space_bytes = std::uint64_t{3} << 30U;
  std::uint64_t processor_seconds = 60;  // then it ends with SIGXCPU
};

// For a program that reads one file from descriptor 0. Closes all descriptors but 0, 1 and 2; bounds memory, processor
// time, files; forbids all system calls but those that reading, writing and memory take. The process ends with the
// thread that started it.
void confine_this_process(const Confinement& limits);

struct NetworkConfinement {
  std::uint64_t address_space_bytes = std::uint64_t{1} << 30U;
  std::span<const std::string> readable = {};  // files and folders; beside them those of the C library and of TLS
  bool tcp = false;                            // it may connect to a TCP port; otherwise UDP only
};

// What of the below is in force. A kernel, or a service manager, may refuse it.
struct ConfinementOutcome {
  bool system_calls = false;
  bool files = false;
};

// For a program that speaks to a network, which keeps descriptors 0 to 2 and kChildMemory: in two steps, each before
// what it guards against.
// 1. Before its library starts: no new privileges, bounds on memory and files, no file but those that are named, no
//    program started, no signal to another process.
[[nodiscard]] ConfinementOutcome confine_to_network(const NetworkConfinement& limits);
// 2. When the library has opened its files: it opens no other. All threads.
void forbid_opening_files();

}  // namespace cellmirror
