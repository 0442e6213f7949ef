// Sines and cosines of the joints of a chain, four at once. The loops of kinematics spend most of their time on them,
// and the library's take one angle at a time. No Eigen and nothing with external linkage, so that sources compiled for
// different instruction sets may include it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rt_core/kinematics/lanes.hpp"

namespace cellmirror::kinematics {

namespace {

// rad; beyond it, sincos_of_lanes() does not reduce exactly
inline constexpr double kLargestAngle = 1e5;

// Of angles (V: a vector of them, B: one of as many 64-bit integers) up to kLargestAngle; the error is below 4e-16.
// Gives false, and nothing of use, where one is beyond or NaN. Reduced to [-pi/4, pi/4] by a quarter turn given in
// three parts (Cody, Waite, Software Manual for the Elementary Functions), then the minimax polynomials of fdlibm
// (k_sin.c, k_cos.c).
template <class V, class B>
CELLMIRROR_LANES bool sincos_of_lanes(const double* angles, double* sines, double* cosines) noexcept {
  V angle;
  std::memcpy(&angle, angles, sizeof angle);
  constexpr double kQuartersPerRadian = 0.63661977236758134308;
  constexpr double kRound = 0x1.8p52;                       // added, it leaves the nearest integer in the low bits
  constexpr double kQuarter1 = 1.57079632673412561417e+00;  // 33 bits, so that times a count of quarters is exact
  constexpr double kQuarter2 = 6.07710050630396597660e-11;
  constexpr double kQuarter3 = 2.02226624879595063154e-21;
  const V rounded = angle * kQuartersPerRadian + kRound;
  const V quarters = rounded - kRound;
  const V r = ((angle - quarters * kQuarter1) - quarters * kQuarter2) - quarters * kQuarter3;

  const V z = r * r;
  const V z2 = z * z;
  const V z4 = z2 * z2;
  const V s = (-1.66666666666666324348e-01 + z * 8.33333333332248946124e-03) +
              z2 * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
              z4 * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
  const V c = (4.16666666666666019037e-02 + z * -1.38888888888741095749e-03) +
              z2 * (2.48015872894767294178e-05 + z * -2.75573143513906633035e-07) +
              z4 * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11);
  const B sine_r = __builtin_bit_cast(B, r + r * z * s);
  const B cosine_r = __builtin_bit_cast(B, (1.0 - 0.5 * z) + z2 * c);

  // An odd count of quarters exchanges the two; bit 1 of it, and of the next one, is their sign.
  const B count = __builtin_bit_cast(B, rounded);
  const B exchange = -(count & 1);
  const V sine = __builtin_bit_cast(V, ((sine_r & ~exchange) | (cosine_r & exchange)) ^ ((count & 2) << 62));
  const V cosine = __builtin_bit_cast(V, ((cosine_r & ~exchange) | (sine_r & exchange)) ^ (((count + 1) & 2) << 62));
  std::memcpy(sines, &sine, sizeof sine);
  std::memcpy(cosines, &cosine, sizeof cosine);

  const B within = (angle <= kLargestAngle) & (angle >= -kLargestAngle);
  std::int64_t all = within[0];
  for (std::size_t i = 1; i < sizeof(V) / sizeof(double); ++i) all &= within[i];
  return all != 0;
}

// Out of line: rarely needed, and it would cost the callers registers.
[[gnu::noinline, maybe_unused]] void sincos_one_by_one(const double* angle, std::size_t count, double* sine,
                                                       double* cosine) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    sine[i] = __builtin_sin(angle[i]);
    cosine[i] = __builtin_cos(angle[i]);
  }
}

// How long arrays for sincos_of() have to be.
[[maybe_unused]] constexpr std::size_t sincos_capacity(std::size_t count) { return (count + 3) / 4 * 4; }

// Of any angles (NaN of what is not finite). The arrays are as long as sincos_capacity() says; elements of `angle`
// beyond `count` must be finite.
CELLMIRROR_LANES void sincos_of(const double* angle, std::size_t count, double* sine, double* cosine) noexcept {
  bool all_reducible = true;
  for (std::size_t i = 0; i < count; i += 4) {
#ifdef __AVX2__
    all_reducible &= sincos_of_lanes<Four, FourBits>(angle + i, sine + i, cosine + i);
#else
    all_reducible &= sincos_of_lanes<Two, TwoBits>(angle + i, sine + i, cosine + i);
    all_reducible &= sincos_of_lanes<Two, TwoBits>(angle + i + 2, sine + i + 2, cosine + i + 2);
#endif
  }
  if (!all_reducible) [[unlikely]]
    sincos_one_by_one(angle, count, sine, cosine);
}

}  // namespace

}  // namespace cellmirror::kinematics
