// Real time: the mark of tick functions, and how much of it the machine has to give.
#pragma once

#include <cstdint>

// A function marked CELL_RT may run in the tick: it is noexcept, does not allocate, does not wait for a lock, formats
// no text, looks up no string and makes no system call but the clock. Tests run such functions under the allocation
// guard, and clang checks the attribute if it supports it.
#if defined(__clang__) && __has_cpp_attribute(clang::nonblocking)
#define CELL_RT noexcept [[clang::nonblocking]]
#else
#define CELL_RT noexcept
#endif

namespace cellmirror {

// Policy for SCHED_FIFO and locked memory.
enum class RealTimePolicy : std::uint8_t {
  require,  // without them the gateway does not start
  prefer,   // used if the machine allows it, otherwise reported and continued without
  off,      // not asked for
};

}  // namespace cellmirror
