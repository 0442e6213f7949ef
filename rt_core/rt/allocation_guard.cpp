#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror {

namespace detail {

// constinit: the interposer uses it before any constructor has run.
constinit thread_local HeapCallCounters heap_calls_of_thread;

namespace {
// Relaxed throughout: counters and a flag that publish nothing but themselves.
constinit std::atomic<std::uint64_t> allocations_of_process{0};
constinit std::atomic<std::uint64_t> frees_of_process{0};
constinit std::atomic<bool> armed{false};
}  // namespace

void note_allocation_in_guard() noexcept {
  ++heap_calls_of_thread.allocations;
  allocations_of_process.fetch_add(1, std::memory_order_relaxed);
}

void note_free_in_guard() noexcept {
  ++heap_calls_of_thread.frees;
  frees_of_process.fetch_add(1, std::memory_order_relaxed);
}

void arm_allocation_guard() noexcept { armed.store(true, std::memory_order_relaxed); }

}  // namespace detail

bool AllocationGuard::armed() CELL_RT { return detail::armed.load(std::memory_order_relaxed); }

std::uint64_t AllocationGuard::allocations_in_guard_of_process() CELL_RT {
  return detail::allocations_of_process.load(std::memory_order_relaxed);
}

std::uint64_t AllocationGuard::frees_in_guard_of_process() CELL_RT {
  return detail::frees_of_process.load(std::memory_order_relaxed);
}

}  // namespace cellmirror
