// Random numbers that are the same on every machine for the same seed; the standard's distributions are not.
#pragma once

#include <cstdint>

namespace cellmirror::sim {

// SplitMix64 (Steele, Lea, Flood 2014): good enough for faults, 8 bytes of state.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed) : state_(seed) {}

  constexpr std::uint64_t bits() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  // In [0, 1).
  constexpr double fraction() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }
  // In [0, n); n > 0. The bias is below n / 2^64.
  constexpr std::uint64_t below(std::uint64_t n) { return bits() % n; }

 private:
  std::uint64_t state_;
};

}  // namespace cellmirror::sim
