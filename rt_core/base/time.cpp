#include "rt_core/base/time.hpp"

#include <atomic>
#include <ctime>
#include <limits>

#include "rt_core/base/wall_clock.hpp"

namespace cellmirror {

namespace {

constexpr std::int64_t kOfThisMachine = std::numeric_limits<std::int64_t>::min();

// Relaxed: it is set before the threads that ask begin.
std::atomic<std::int64_t> wall_clock_offset{kOfThisMachine};

std::int64_t read_clock(clockid_t id) noexcept {
  timespec t{};
  clock_gettime(id, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

std::int64_t machine_offset() { return read_clock(CLOCK_REALTIME) - read_clock(CLOCK_MONOTONIC); }

std::int64_t offset_ns() {
  const std::int64_t set = wall_clock_offset.load(std::memory_order_relaxed);
  return set == kOfThisMachine ? machine_offset() : set;
}

}  // namespace

Timestamp SystemClock::now() const CELL_RT { return Timestamp{read_clock(CLOCK_MONOTONIC)}; }

void set_wall_clock_offset(Nanoseconds utc_minus_instant) {
  wall_clock_offset.store(utc_minus_instant.count(), std::memory_order_relaxed);
}

std::int64_t machine_wall_clock_ns(Timestamp t) { return t.ns + machine_offset(); }

std::int64_t to_wall_clock_ns(Timestamp t) { return t.ns + offset_ns(); }

Timestamp from_wall_clock_ns(std::int64_t wall_ns) {
  // Wrapping arithmetic: the number comes from outside and may be anything.
  const auto ns =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(wall_ns) - static_cast<std::uint64_t>(offset_ns()));
  return wall_ns <= 0 || ns <= 0 ? Timestamp{} : Timestamp{ns};
}

}  // namespace cellmirror
