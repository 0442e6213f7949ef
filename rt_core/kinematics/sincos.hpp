// Sines and cosines of the joints of a chain, four at once. The loops of kinematics spend most of their time on them,
// and the library's take one angle at a time. No Eigen and nothing with external linkage, so that sources compiled for
// different instruction sets may include it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace cellmirror::kinematics {

// Passed by reference only: how they are passed by value depends on the instruction set.
using Four [[gnu::vector_size(32)]] = double;
using FourBits [[gnu::vector_size(32)]] = std::int64_t;

// rad; beyond it, sincos_of_four() does not reduce exactly. Not true of NaN.
inline constexpr double kLargestAngle = 1e5;
[[gnu::always_inline]] static inline bool reducible(const Four& angle) noexcept {
  const FourBits within = (angle <= kLargestAngle) & (angle >= -kLargestAngle);
  return (within[0] & within[1] & within[2] & within[3]) != 0;
}

// Of reducible angles; the error is below 4e-16. Reduced to [-pi/4, pi/4] by a quarter turn given in three parts (Cody,
// Waite, Software Manual for the Elementary Functions), then the minimax polynomials of fdlibm (k_sin.c, k_cos.c).
[[gnu::always_inline]] static inline void sincos_of_four(const Four& angle, Four& sine, Four& cosine) noexcept {
  constexpr double kQuartersPerRadian = 0.63661977236758134308;
  constexpr double kRound = 0x1.8p52;                       // added, it leaves the nearest integer in the low bits
  constexpr double kQuarter1 = 1.57079632673412561417e+00;  // 33 bits, so that times a count of quarters is exact
  constexpr double kQuarter2 = 6.07710050630396597660e-11;
  constexpr double kQuarter3 = 2.02226624879595063154e-21;
  const Four rounded = angle * kQuartersPerRadian + kRound;
  const Four quarters = rounded - kRound;
  const Four r = ((angle - quarters * kQuarter1) - quarters * kQuarter2) - quarters * kQuarter3;

  const Four z = r * r;
  const Four z2 = z * z;
  const Four z4 = z2 * z2;
  const Four s = (-1.66666666666666324348e-01 + z * 8.33333333332248946124e-03) +
                 z2 * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                 z4 * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
  const Four c = (4.16666666666666019037e-02 + z * -1.38888888888741095749e-03) +
                 z2 * (2.48015872894767294178e-05 + z * -2.75573143513906633035e-07) +
                 z4 * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11);
  const FourBits sine_r = __builtin_bit_cast(FourBits, r + r * z * s);
  const FourBits cosine_r = __builtin_bit_cast(FourBits, (1.0 - 0.5 * z) + z2 * c);

  // An odd count of quarters exchanges the two; bit 1 of it, and of the next one, is their sign.
  const FourBits count = __builtin_bit_cast(FourBits, rounded);
  const FourBits exchange = -(count & 1);
  sine = __builtin_bit_cast(Four, ((sine_r & ~exchange) | (cosine_r & exchange)) ^ ((count & 2) << 62));
  cosine = __builtin_bit_cast(Four, ((cosine_r & ~exchange) | (sine_r & exchange)) ^ (((count + 1) & 2) << 62));
}

// Out of line: rarely needed, and it would cost the callers registers.
[[gnu::noinline]] [[maybe_unused]] static void sincos_one_by_one(const double* angle, std::size_t count, double* sine,
                                                                 double* cosine) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    sine[i] = __builtin_sin(angle[i]);
    cosine[i] = __builtin_cos(angle[i]);
  }
}

// How long arrays for sincos_of() have to be.
[[maybe_unused]] static constexpr std::size_t sincos_capacity(std::size_t count) { return (count + 3) / 4 * 4; }

// Of any angles (NaN of what is not finite). The arrays are as long as sincos_capacity() says; what stands in `angle`
// beyond `count` has to be finite.
[[gnu::always_inline]] static inline void sincos_of(const double* angle, std::size_t count, double* sine,
                                                    double* cosine) noexcept {
  bool all_reducible = true;
  for (std::size_t i = 0; i < count; i += 4) {
    Four at;
    Four s;
    Four c;
    std::memcpy(&at, angle + i, sizeof at);
    sincos_of_four(at, s, c);
    std::memcpy(sine + i, &s, sizeof s);
    std::memcpy(cosine + i, &c, sizeof c);
    all_reducible = all_reducible && reducible(at);
  }
  if (!all_reducible) [[unlikely]]
    sincos_one_by_one(angle, count, sine, cosine);
}

}  // namespace cellmirror::kinematics
