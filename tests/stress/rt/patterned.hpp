// A value of several cache lines in which every word follows from the number, so that any mixture of two values shows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cellmirror {

#ifdef CELLMIRROR_SANITIZED
inline constexpr std::uint64_t kOperations = 300'000;
#else
inline constexpr std::uint64_t kOperations = 2'000'000;
#endif

struct Patterned {
  static constexpr std::size_t kWords = 24;
  std::uint64_t number = 0;
  std::array<std::uint64_t, kWords> words{};

  static Patterned of(std::uint64_t number) {
    Patterned value;
    value.fill(number);
    return value;
  }
  void fill(std::uint64_t new_number) {
    number = new_number;
    for (std::size_t i = 0; i < kWords; ++i) {
      words[i] = word(new_number, i);
    }
  }
  [[nodiscard]] bool whole() const {
    for (std::size_t i = 0; i < kWords; ++i) {
      if (words[i] != word(number, i)) {
        return false;
      }
    }
    return true;
  }

 private:
  // Any function that spreads the bits; multipliers of the SplitMix64 generator (Steele, Lea, Flood 2014).
  static std::uint64_t word(std::uint64_t number, std::size_t i) {
    return number * (0x9E3779B97F4A7C15ULL + 2 * i * 0xBF58476D1CE4E5B9ULL);  // 0 for the default value
  }
};

}  // namespace cellmirror
