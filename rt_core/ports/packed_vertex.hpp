// Places and normals of a surface's vertices as few bits, and back. Pure.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace cellmirror {

inline constexpr float kPackedSteps = 65535.0F;  // of an edge of the surface's box

// Where `value` is between `low` and `low + edge`: 0 to 65535.
[[nodiscard]] inline std::uint16_t packed_in_box(float value, float low, float edge) {
  if (!(edge > 0.0F)) return 0;
  return static_cast<std::uint16_t>(std::lround(kPackedSteps * std::clamp((value - low) / edge, 0.0F, 1.0F)));
}
[[nodiscard]] inline float unpacked_in_box(std::uint16_t packed, float low, float edge) {
  return low + edge * static_cast<float>(packed) / kPackedSteps;
}

// Octahedral: a unit vector as two numbers of -127 to 127 (Meyer et al., "On floating-point normal vectors", 2010).
[[nodiscard]] inline std::array<std::int8_t, 2> packed_normal(const Eigen::Vector3f& normal) {
  const float sum = normal.cwiseAbs().sum();
  if (!std::isfinite(sum) || sum <= 0.0F) return {0, 0};
  float x = normal.x() / sum;
  float y = normal.y() / sum;
  if (normal.z() < 0.0F) {
    const float folded = (1.0F - std::abs(y)) * (x < 0.0F ? -1.0F : 1.0F);
    y = (1.0F - std::abs(x)) * (y < 0.0F ? -1.0F : 1.0F);
    x = folded;
  }
  return {static_cast<std::int8_t>(std::lround(127.0F * x)), static_cast<std::int8_t>(std::lround(127.0F * y))};
}
[[nodiscard]] inline Eigen::Vector3f unpacked_normal(const std::array<std::int8_t, 2>& packed) {
  const float x = static_cast<float>(packed[0]) / 127.0F;
  const float y = static_cast<float>(packed[1]) / 127.0F;
  Eigen::Vector3f out(x, y, 1.0F - std::abs(x) - std::abs(y));
  if (out.z() < 0.0F) {
    out.x() = (1.0F - std::abs(y)) * (x < 0.0F ? -1.0F : 1.0F);
    out.y() = (1.0F - std::abs(x)) * (y < 0.0F ? -1.0F : 1.0F);
  }
  return out.normalized();  // the sum of its absolute values is 1 or more: it is never zero
}

// 0 raw, 1 coagulated, 2 charred, as 0 to 255.
[[nodiscard]] inline std::uint8_t packed_burn(float burn) {
  return static_cast<std::uint8_t>(std::lround(127.5F * (std::isfinite(burn) ? std::clamp(burn, 0.0F, 2.0F) : 0.0F)));
}
[[nodiscard]] inline float unpacked_burn(std::uint8_t packed) { return static_cast<float>(packed) / 127.5F; }

}  // namespace cellmirror
