// Eight floats side by side, in the registers that the instruction set of the including source has: one of 256 bits
// with AVX2, else two of 128. (Compilers take vectors that are wider than the registers apart into single numbers.)
// Everything has internal linkage: sources compiled for different instruction sets must not share it.
#pragma once

#include <cstdint>
#include <cstring>

namespace cellmirror::geometry {

namespace {

#define CELLMIRROR_LANE [[gnu::always_inline, maybe_unused]] inline

#ifdef __AVX2__
using FloatRegister [[gnu::vector_size(32)]] = float;
using BitRegister [[gnu::vector_size(32)]] = std::int32_t;
#else
using FloatRegister [[gnu::vector_size(16)]] = float;
using BitRegister [[gnu::vector_size(16)]] = std::int32_t;
#endif

struct Eight {
  static constexpr unsigned kRegisters = 32 / sizeof(FloatRegister);
  FloatRegister part[kRegisters];
};

CELLMIRROR_LANE Eight load(const float* from) noexcept {
  Eight out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
CELLMIRROR_LANE void store(const Eight& from, float* to) noexcept { std::memcpy(to, &from, sizeof from); }
CELLMIRROR_LANE Eight same(float value) noexcept {
  Eight out;
  for (FloatRegister& part : out.part) part = value - FloatRegister{};
  return out;
}

#define CELLMIRROR_EACH(expression)                                            \
  Eight out;                                                                   \
  for (unsigned i = 0; i < Eight::kRegisters; ++i) out.part[i] = (expression); \
  return out

CELLMIRROR_LANE Eight operator+(const Eight& a, const Eight& b) noexcept { CELLMIRROR_EACH(a.part[i] + b.part[i]); }
CELLMIRROR_LANE Eight operator-(const Eight& a, const Eight& b) noexcept { CELLMIRROR_EACH(a.part[i] - b.part[i]); }
CELLMIRROR_LANE Eight operator*(const Eight& a, const Eight& b) noexcept { CELLMIRROR_EACH(a.part[i] * b.part[i]); }
CELLMIRROR_LANE Eight operator+(const Eight& a, float b) noexcept { CELLMIRROR_EACH(a.part[i] + b); }
CELLMIRROR_LANE Eight operator-(const Eight& a, float b) noexcept { CELLMIRROR_EACH(a.part[i] - b); }
CELLMIRROR_LANE Eight operator*(float a, const Eight& b) noexcept { CELLMIRROR_EACH(a * b.part[i]); }
CELLMIRROR_LANE Eight larger(const Eight& a, const Eight& b) noexcept {
  CELLMIRROR_EACH(a.part[i] > b.part[i] ? a.part[i] : b.part[i]);
}
CELLMIRROR_LANE Eight positive(const Eight& a) noexcept { return larger(a, same(0)); }
CELLMIRROR_LANE Eight absolute(const Eight& a) noexcept {
  CELLMIRROR_EACH(reinterpret_cast<FloatRegister>(reinterpret_cast<BitRegister>(a.part[i]) & 0x7fffffff));
}

#undef CELLMIRROR_EACH

}  // namespace

}  // namespace cellmirror::geometry
