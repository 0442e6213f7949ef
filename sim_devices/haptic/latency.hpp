// From a sample that was written to the force that answers it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror::sim {

// Durations in steps of 10 us up to 100 ms; longer ones count as the last step, the maximum is exact.
class DurationHistogram {
 public:
  DurationHistogram() : counts_(kSteps, 0) {}
  void add(Nanoseconds duration);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  // Upper edge of the step that holds the share; 0 if there is none. `share`: 0 to 1.
  [[nodiscard]] double quantile_us(double share) const;
  [[nodiscard]] double max_us() const { return 1e-3 * static_cast<double>(max_.count()); }

 private:
  static constexpr std::size_t kSteps = 10001;
  static constexpr std::int64_t kStepNs = 10'000;
  std::vector<std::uint64_t> counts_;
  std::uint64_t count_ = 0;
  Nanoseconds max_{};
};

// When each of the last samples was written.
class WriteTimes {
 public:
  void note(std::uint64_t sequence, Timestamp written);
  // Zero where it is not known any more.
  [[nodiscard]] Timestamp of(std::uint64_t sequence) const;

 private:
  struct Entry {
    std::uint64_t sequence = 0;
    Timestamp written;
  };
  std::array<Entry, 1024> entries_{};
};

}  // namespace cellmirror::sim
