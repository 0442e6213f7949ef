// Lower bounds of the distances between a box and the eight children of a node of another tree: the innermost step of
// every walk. Compiled for several instruction sets; the processor's best is chosen once.
#pragma once

#include <array>
#include <cstddef>

#include "rt_core/geometry/wide_node.hpp"

namespace cellmirror::geometry {

// A box of body O, in the frame N of the node that it is compared with. Single precision, m.
struct BoxQuery {
  std::array<float, 3> centre{};
  std::array<std::array<float, 3>, 3> axes{};  // unit vectors
  std::array<float, 3> half{};                 // m, along the axes
  // A direction in which the bodies may be well apart, at best that of their nearest points; zero: none is known.
  std::array<float, 3> direction{};
};

// Relative pose of the frames of two trees' boxes: p_N = R_NO * p_O + p_NO.
struct BoxFrame {
  std::array<std::array<float, 3>, 3> R_NO{};
  std::array<float, 3> p_NO{};
};

struct BoxKernels {
  // Squares of the bounds, m^2; too large by no more than rounding, see kBoundMargin.
  void (*bounds)(const WideNode& node, const BoxQuery& box, float* squares) noexcept;
  // Box in a place of a node of O; `direction` is left as it is.
  void (*place_box)(const WideNode& node, std::size_t place, const BoxFrame& frame, BoxQuery& box) noexcept;
};

// What the bounds lose by single precision, at most, in parts of the lengths involved: a dozen roundings, each of
// 2^-24, in sums of up to four terms.
inline constexpr double kBoundMargin = 64.0 / (1U << 24U);

[[nodiscard]] const BoxKernels& box_kernels() noexcept;

namespace baseline {
[[nodiscard]] BoxKernels box_kernels() noexcept;
}
namespace avx2 {
[[nodiscard]] BoxKernels box_kernels() noexcept;
}

}  // namespace cellmirror::geometry
