// Lower bounds of the distances between a box and the eight children of a node of another tree: the innermost step of
// every walk. Compiled for several instruction sets; the processor's best is chosen once.
#pragma once

#include <array>
#include <cstddef>

#include "rt_core/geometry/wide_tree.hpp"

namespace cellmirror::geometry {

// How the frame N of a node stands to the frame O of the box' own axes. The same for all boxes of a tree.
struct BoxFrame {
  std::array<std::array<float, 3>, 3> R_ON{};
  std::array<std::array<float, 3>, 3> absolute_R_ON{};
};

// A box with a slab, seen from N. Single precision, m.
struct BoxQuery {
  std::array<float, 3> centre_N{};  // of the box
  std::array<float, 3> reach_N{};   // half its extent along the axes of N
  std::array<float, 3> half_O{};
  std::array<float, 3> shift_O{};   // a point p_N is at R_ON * p_N + shift_O from the box' centre
  std::array<float, 3> normal_N{};  // of the slab; zero: none
  std::array<float, 3> absolute_normal_N{};
  float middle_N = 0;  // of the slab along normal_N
  float thick = 0;
};

// Squares of the bounds, m^2, too large by no more than rounding: see RelativeFrame::margin.
using ChildBounds = void (*)(const WideNode& node, const BoxFrame& frame, const BoxQuery& box, float* squares) noexcept;
[[nodiscard]] ChildBounds child_bounds() noexcept;

namespace baseline {
[[nodiscard]] ChildBounds child_bounds() noexcept;
}
namespace avx2 {
[[nodiscard]] ChildBounds child_bounds() noexcept;
}

}  // namespace cellmirror::geometry
