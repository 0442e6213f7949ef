#include "rt_core/base/time.hpp"

#include <ctime>

namespace cellmirror {

namespace {

std::int64_t read_clock(clockid_t id) noexcept {
  timespec t{};
  clock_gettime(id, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

Timestamp SystemClock::now() const CELL_RT { return Timestamp{read_clock(CLOCK_MONOTONIC)}; }

std::int64_t to_wall_clock_ns(Timestamp t) { return t.ns + read_clock(CLOCK_REALTIME) - read_clock(CLOCK_MONOTONIC); }

Timestamp from_wall_clock_ns(std::int64_t wall_ns) {
  // Wrapping arithmetic: the number comes from outside and may be anything.
  const std::int64_t offset = read_clock(CLOCK_REALTIME) - read_clock(CLOCK_MONOTONIC);
  const auto ns = static_cast<std::int64_t>(static_cast<std::uint64_t>(wall_ns) - static_cast<std::uint64_t>(offset));
  return wall_ns <= 0 || ns <= 0 ? Timestamp{} : Timestamp{ns};
}

}  // namespace cellmirror
