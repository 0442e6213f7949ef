// Restrictions that a program applies to itself before it reads a stranger's file or datagram, so that a flaw in a
// library can at worst end that program. Linux; a restriction that the kernel lacks is left out and reported. Builds
// with sanitizers limit neither memory nor descriptors nor system calls, since the sanitizers' run time needs them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace cellmirror {

// Exit status of a program that has used up its memory limit.
inline constexpr int kOutOfMemoryStatus = 71;

struct Confinement {
  std::uint64_t address_space_bytes = std::uint64_t{3} << 30U;
  std::uint64_t processor_seconds = 60;  // then it ends with SIGXCPU
};

// Confines a program that reads one file from descriptor 0. Closes all descriptors except 0, 1 and 2, limits memory,
// processor time and files, and permits only the system calls for reading, writing and memory. The kernel ends the
// process together with the thread that started it.
void confine_this_process(const Confinement& limits);

struct NetworkConfinement {
  std::uint64_t address_space_bytes = std::uint64_t{1} << 30U;
  std::span<const std::string> readable = {};  // files and folders, in addition to those of the C library and of TLS
  bool tcp = false;                            // true: it may connect to TCP ports; false: UDP only
};

// Restrictions that are in force. A kernel or a service manager may refuse them.
struct ConfinementOutcome {
  bool system_calls = false;
  bool files = false;
};

// Confines a program that communicates over a network, in two steps. It keeps descriptors 0 to kChildMemory.
// First step, before its library starts: no new privileges, a memory limit, no writable file, only the named readable
// files, no new processes or programs, no signals to other processes.
[[nodiscard]] ConfinementOutcome confine_to_network(const NetworkConfinement& limits);
// Second step, after the library has read its files: no thread of the process can open a file any more.
void forbid_opening_files();

}  // namespace cellmirror
