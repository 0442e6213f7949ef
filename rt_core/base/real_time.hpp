// Real time: the mark of tick functions, and how much of it the machine has to give.
#pragma once

#include <cstdint>

// A function that bears CELL_RT may run in the tick: it is noexcept, takes no heap memory, waits for no lock, formats
// no text, looks up no string and makes no system call but the clock. The mark is the only statement of that contract;
// tests run such functions under the allocation guard, and clang checks the attribute where it knows it.
#if defined(__clang__) && __has_cpp_attribute(clang::nonblocking)
#define CELL_RT noexcept [[clang::nonblocking]]
#else
#define CELL_RT noexcept
#endif

namespace cellmirror {

// How to ask for SCHED_FIFO and locked memory.
enum class RealTimePolicy : std::uint8_t {
  require,  // without them the gateway does not start
  prefer,   // taken where the machine allows it, else told and done without
  off,      // not asked for
};

}  // namespace cellmirror
