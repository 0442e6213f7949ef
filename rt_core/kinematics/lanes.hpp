// Four doubles side by side, in the registers that the instruction set of the including source has: one of 256 bits
// with AVX2, else two of 128. (Compilers take vectors that are wider than the registers apart into single numbers.)
// Everything has internal linkage: sources compiled for different instruction sets must not share it.
#pragma once

#include <cstdint>
#include <cstring>

namespace cellmirror::kinematics {

namespace {

using Two [[gnu::vector_size(16)]] = double;
using TwoBits [[gnu::vector_size(16)]] = std::int64_t;

#define CELLMIRROR_LANES [[gnu::always_inline, maybe_unused]] inline

#ifdef __AVX2__

using Four [[gnu::vector_size(32)]] = double;
using FourBits [[gnu::vector_size(32)]] = std::int64_t;

CELLMIRROR_LANES void set(Four& to, double a, double b, double c, double d) noexcept { to = Four{a, b, c, d}; }
// (x, y, z, w) becomes (y, z, x, w).
CELLMIRROR_LANES void turn_lanes(const Four& from, Four& to) noexcept {
  to = __builtin_shufflevector(from, from, 1, 2, 0, 3);
}
// The first three lanes of each, one after the other.
CELLMIRROR_LANES void store_threes(const Four& a, const Four& b, double* to) noexcept {
  const Four first = __builtin_shufflevector(a, b, 0, 1, 2, 4);
  const Two second = __builtin_shufflevector(b, b, 1, 2);
  std::memcpy(to, &first, sizeof first);
  std::memcpy(to + 4, &second, sizeof second);
}

#else

struct Four {
  Two low;
  Two high;
};

CELLMIRROR_LANES Four operator+(const Four& a, const Four& b) noexcept { return {a.low + b.low, a.high + b.high}; }
CELLMIRROR_LANES Four operator-(const Four& a, const Four& b) noexcept { return {a.low - b.low, a.high - b.high}; }
CELLMIRROR_LANES Four operator*(const Four& a, const Four& b) noexcept { return {a.low * b.low, a.high * b.high}; }
CELLMIRROR_LANES Four operator*(double a, const Four& b) noexcept { return {a * b.low, a * b.high}; }
CELLMIRROR_LANES Four& operator+=(Four& a, const Four& b) noexcept { return a = a + b; }

CELLMIRROR_LANES void set(Four& to, double a, double b, double c, double d) noexcept { to = {Two{a, b}, Two{c, d}}; }
CELLMIRROR_LANES void turn_lanes(const Four& from, Four& to) noexcept {
  to = {__builtin_shufflevector(from.low, from.high, 1, 2), __builtin_shufflevector(from.low, from.high, 0, 3)};
}
CELLMIRROR_LANES void store_threes(const Four& a, const Four& b, double* to) noexcept {
  const Two parts[] = {a.low, __builtin_shufflevector(a.high, b.low, 0, 2),
                       __builtin_shufflevector(b.low, b.high, 1, 2)};
  std::memcpy(to, parts, sizeof parts);
}

#endif

CELLMIRROR_LANES void load(const double* from, Four& to) noexcept { std::memcpy(&to, from, sizeof to); }
CELLMIRROR_LANES void store(const Four& from, double* to) noexcept { std::memcpy(to, &from, sizeof from); }

}  // namespace

}  // namespace cellmirror::kinematics
