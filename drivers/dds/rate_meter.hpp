// How many events a second, over the last second.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rt_core/base/time.hpp"

namespace cellmirror::dds {

// Counts in slices of a tenth of a second, so it costs the same at every rate. Not synchronized.
class RateMeter {
 public:
  void count(Timestamp now) {
    advance(now);
    ++slices_[static_cast<std::size_t>(newest_ % kSlices)];
  }
  // Over the ten whole slices before the running one.
  [[nodiscard]] double per_second(Timestamp now) {
    advance(now);
    std::uint64_t sum = 0;
    for (const std::uint32_t n : slices_) sum += n;
    return static_cast<double>(sum - slices_[static_cast<std::size_t>(newest_ % kSlices)]);
  }

 private:
  static constexpr std::int64_t kSliceNs = 100'000'000;
  static constexpr std::int64_t kSlices = 11;  // ten whole ones make a second, and the running one

  void advance(Timestamp now) {
    const std::int64_t slice = now.ns / kSliceNs;
    if (slice - newest_ >= kSlices) slices_.fill(0);
    for (std::int64_t s = newest_ + 1; s <= slice && slice - newest_ < kSlices; ++s) {
      slices_[static_cast<std::size_t>(s % kSlices)] = 0;
    }
    if (slice > newest_) newest_ = slice;
  }

  std::array<std::uint32_t, static_cast<std::size_t>(kSlices)> slices_{};
  std::int64_t newest_ = 0;
};

}  // namespace cellmirror::dds
