// Time. Inside, every instant is a Timestamp on the machine's monotonic clock; wall-clock time appears only where a
// protocol requires it (DDS headers, logs) and is converted there.
#pragma once

#include <chrono>
#include <compare>
#include <cstdint>

#include "rt_core/base/real_time.hpp"

namespace cellmirror {

using Nanoseconds = std::chrono::nanoseconds;

// An instant of CLOCK_MONOTONIC, in nanoseconds. Zero means "never".
struct Timestamp {
  std::int64_t ns = 0;

  [[nodiscard]] constexpr bool known() const { return ns != 0; }
  constexpr auto operator<=>(const Timestamp&) const = default;
};

constexpr Nanoseconds operator-(Timestamp a, Timestamp b) { return Nanoseconds(a.ns - b.ns); }
constexpr Timestamp operator+(Timestamp t, Nanoseconds d) { return Timestamp{t.ns + d.count()}; }
constexpr Timestamp operator-(Timestamp t, Nanoseconds d) { return Timestamp{t.ns - d.count()}; }
constexpr double seconds(Nanoseconds d) { return 1e-9 * static_cast<double>(d.count()); }

// Where time comes from. The tick reads it once a period; tests use ManualClock.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual Timestamp now() const CELL_RT = 0;
};

class SystemClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const CELL_RT override;
};

class ManualClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const CELL_RT override { return now_; }
  void set(Timestamp now) { now_ = now; }
  void advance(Nanoseconds by) { now_ = now_ + by; }

 private:
  Timestamp now_{1};
};

// Nanoseconds since 1970 (CLOCK_REALTIME) at a monotonic instant, by the offset between the clocks at the time of the
// call. Not for the tick.
[[nodiscard]] std::int64_t to_wall_clock_ns(Timestamp t);
// The inverse. A wall-clock time before the machine's start gives "never".
[[nodiscard]] Timestamp from_wall_clock_ns(std::int64_t wall_ns);

}  // namespace cellmirror
