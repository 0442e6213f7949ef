#include "sim_devices/haptic/latency.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::sim {

void DurationHistogram::add(Nanoseconds duration) {
  const std::int64_t ns = std::max<std::int64_t>(duration.count(), 0);
  const auto step = std::min<std::size_t>(static_cast<std::size_t>(ns / kStepNs), kSteps - 1);
  ++counts_[step];
  ++count_;
  max_ = std::max(max_, Nanoseconds(ns));
}

double DurationHistogram::quantile_us(double share) const {
  if (count_ == 0) return 0;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    seen += counts_[i];
    if (seen >= std::max<std::uint64_t>(wanted, 1)) {
      return std::min(1e-3 * static_cast<double>(kStepNs) * static_cast<double>(i + 1), max_us());
    }
  }
  return max_us();
}

void WriteTimes::note(std::uint64_t sequence, Timestamp written) {
  entries_[sequence % entries_.size()] = {sequence, written};
}

Timestamp WriteTimes::of(std::uint64_t sequence) const {
  const Entry& entry = entries_[sequence % entries_.size()];
  return entry.sequence == sequence ? entry.written : Timestamp{};
}

}  // namespace cellmirror::sim
