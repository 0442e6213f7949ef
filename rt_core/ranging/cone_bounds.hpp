// Which children of a node of a wide tree a cone may meet, and how near they are: the innermost step of a walk.
// Compiled for several instruction sets; the processor's best is chosen once. Private to this folder.
#pragma once

#include <array>

#include "rt_core/geometry/wide_node.hpp"

namespace cellmirror::ranging {

// In the frame and from the origin of the wide tree; single precision.
struct SingleCone {
  std::array<float, 3> apex{};  // m
  std::array<float, 3> axis{};  // unit vector
  float sine = 0;               // of the half-angle
  float cosine = 1;
  float margin = 0;  // m^2: what rounding may add to a difference of products of two lengths
};

// What single precision loses, at most, in parts of the lengths involved: a dozen roundings, each of 2^-24.
inline constexpr double kSingleMargin = 32.0 / (1U << 24U);
inline constexpr float kBesideCone = 1e30F;  // the square of a box that the cone does not meet

struct ConeKernels {
  // Squares of bounds of the boxes' distances from the apex, m^2; too large by no more than rounding.
  void (*bounds)(const geometry::WideNode& node, const SingleCone& cone, float* squares) noexcept;
};

[[nodiscard]] const ConeKernels& cone_kernels() noexcept;

namespace baseline {
[[nodiscard]] ConeKernels cone_kernels() noexcept;
}
namespace avx2 {
[[nodiscard]] ConeKernels cone_kernels() noexcept;
}

}  // namespace cellmirror::ranging
