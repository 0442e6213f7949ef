// The noise of a sensor: the same numbers on every machine for the same seed. Private to this folder.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace cellmirror::ranging {

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : seed_(seed), state_(seed) {}
  [[nodiscard]] std::uint64_t seed() const { return seed_; }

  // Normal distribution, mean 0, standard deviation 1. Source: Box, Muller 1958.
  double next() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  // In [0, 1). Source: SplitMix64, Steele, Lea, Flood 2014.
  double uniform() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    z ^= z >> 31U;
    constexpr double kStep = 0x1p-53;
    return static_cast<double>(z >> 11U) * kStep;
  }

  std::uint64_t seed_;
  std::uint64_t state_;
};

}  // namespace cellmirror::ranging
