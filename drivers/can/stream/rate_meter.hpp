// How many events a second, over the last second.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/base/time.hpp"

namespace cellmirror::can {

class RateMeter {
 public:
  void note(Timestamp now) {
    const std::int64_t slot = now.ns / kSlot_ns;
    Bucket& bucket = buckets_[static_cast<std::size_t>(slot) % kBuckets];
    if (bucket.slot != slot) bucket = {slot, 0};
    ++bucket.count;
  }
  // Over the ten whole slots before the one under way.
  [[nodiscard]] double hz(Timestamp now) const {
    const std::int64_t slot = now.ns / kSlot_ns;
    std::uint64_t count = 0;
    for (const Bucket& bucket : buckets_) {
      if (bucket.slot < slot && bucket.slot >= slot - kSlotsOfASecond) count += bucket.count;
    }
    return static_cast<double>(count);
  }

 private:
  struct Bucket {
    std::int64_t slot = -1;
    std::uint64_t count = 0;
  };
  static constexpr std::int64_t kSlot_ns = 100'000'000;
  static constexpr std::int64_t kSlotsOfASecond = 10;
  static constexpr std::size_t kBuckets = 11;

  std::array<Bucket, kBuckets> buckets_{};
};

}  // namespace cellmirror::can
