// Proves that a piece of code leaves the heap alone.
#pragma once

#include <atomic>
#include <cstdint>

#include "rt_core/base/real_time.hpp"

namespace cellmirror {

namespace detail {
struct HeapCallCounters {
  int depth = 0;  // guards alive on this thread
  std::uint64_t allocations = 0;
  std::uint64_t frees = 0;
};
extern constinit thread_local HeapCallCounters heap_calls_of_thread;
// Called by the interposer on a thread inside a guard. A debugger's breakpoint here shows who allocates.
void note_allocation_in_guard() noexcept;
void note_free_in_guard() noexcept;
void arm_allocation_guard() noexcept;
}  // namespace detail

// While one lives, heap calls of its thread are counted: malloc, calloc, realloc, aligned_alloc, posix_memalign,
// memalign, and so operator new, as allocations; free and operator delete of a real block as frees. Guards nest. It
// counts, it does not forbid: the caller (a test, the cyclic thread, `status`) compares.
//
// Counting needs the interposer: link the object library cellmirror_allocation_guard into the PROGRAM (in sanitizer
// builds it hooks into the interposers of those). Without it armed() is false and everything stays 0; tests assert
// armed().
class AllocationGuard {
 public:
  AllocationGuard() CELL_RT {
    detail::HeapCallCounters& counters = detail::heap_calls_of_thread;
    ++counters.depth;
    allocations_at_start_ = counters.allocations;
    frees_at_start_ = counters.frees;
  }
  ~AllocationGuard() { --detail::heap_calls_of_thread.depth; }
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  // Since this guard began; to be asked on its own thread.
  [[nodiscard]] std::uint64_t allocations() const CELL_RT {
    return detail::heap_calls_of_thread.allocations - allocations_at_start_;
  }
  [[nodiscard]] std::uint64_t frees() const CELL_RT { return detail::heap_calls_of_thread.frees - frees_at_start_; }

  // Whether the interposer is linked in and counts.
  [[nodiscard]] static bool armed() CELL_RT;
  // Within guards: of the calling thread, and of all threads of the process, since their start.
  [[nodiscard]] static std::uint64_t allocations_in_guard() CELL_RT { return detail::heap_calls_of_thread.allocations; }
  [[nodiscard]] static std::uint64_t allocations_in_guard_of_process() CELL_RT;
  [[nodiscard]] static std::uint64_t frees_in_guard_of_process() CELL_RT;

 private:
  std::uint64_t allocations_at_start_ = 0;
  std::uint64_t frees_at_start_ = 0;
};

}  // namespace cellmirror
