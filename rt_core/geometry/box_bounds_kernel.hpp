// The bounds of box_bounds.hpp on plain numbers, one loop that compilers turn into vector instructions. Included by one
// source for each instruction set, which defines CELLMIRROR_KERNELS as the namespace of its own. Nothing inline of a
// library is used but the access to arrays' memory: the linker would merge code of different instruction sets.
#pragma once

#include "rt_core/geometry/box_bounds.hpp"

namespace cellmirror::geometry::CELLMIRROR_KERNELS {

namespace {

#define CELLMIRROR_LANE [[gnu::always_inline, maybe_unused]] inline

CELLMIRROR_LANE float positive(float value) { return value > 0.0F ? value : 0.0F; }
CELLMIRROR_LANE float larger(float a, float b) { return a > b ? a : b; }
CELLMIRROR_LANE float absolute(float value) { return __builtin_fabsf(value); }

// Axis-parallel boxes of either frame: the three gaps are at right angles, so their squares add. Slabs: one gap each.
void bounds(const WideNode& node, const BoxFrame& frame, const BoxQuery& box, float* __restrict squares) noexcept {
  const float* const cx = reinterpret_cast<const float*>(&node.centre);
  const float* const hx = reinterpret_cast<const float*>(&node.half);
  const float* const nx = reinterpret_cast<const float*>(&node.normal);
  const float* const middle = reinterpret_cast<const float*>(&node.middle);
  const float* const thick = reinterpret_cast<const float*>(&node.thick);
  const float* const R = reinterpret_cast<const float*>(&frame.R_ON);
  const float* const A = reinterpret_cast<const float*>(&frame.absolute_R_ON);
  const float* const centre = reinterpret_cast<const float*>(&box.centre_N);
  const float* const reach = reinterpret_cast<const float*>(&box.reach_N);
  const float* const half = reinterpret_cast<const float*>(&box.half_O);
  const float* const shift = reinterpret_cast<const float*>(&box.shift_O);
  const float* const normal = reinterpret_cast<const float*>(&box.normal_N);
  const float* const absolute_normal = reinterpret_cast<const float*>(&box.absolute_normal_N);
  constexpr std::size_t kW = WideNode::kWidth;
  for (std::size_t i = 0; i < kW; ++i) {
    const float c0 = cx[i];
    const float c1 = cx[kW + i];
    const float c2 = cx[2 * kW + i];
    const float h0 = hx[i];
    const float h1 = hx[kW + i];
    const float h2 = hx[2 * kW + i];
    const float g0 = positive(absolute(c0 - centre[0]) - (h0 + reach[0]));
    const float g1 = positive(absolute(c1 - centre[1]) - (h1 + reach[1]));
    const float g2 = positive(absolute(c2 - centre[2]) - (h2 + reach[2]));
    const float along_node = g0 * g0 + g1 * g1 + g2 * g2;
    const float o0 = positive(absolute(R[0] * c0 + R[1] * c1 + R[2] * c2 + shift[0]) -
                              (A[0] * h0 + A[1] * h1 + A[2] * h2 + half[0]));
    const float o1 = positive(absolute(R[3] * c0 + R[4] * c1 + R[5] * c2 + shift[1]) -
                              (A[3] * h0 + A[4] * h1 + A[5] * h2 + half[1]));
    const float o2 = positive(absolute(R[6] * c0 + R[7] * c1 + R[8] * c2 + shift[2]) -
                              (A[6] * h0 + A[7] * h1 + A[8] * h2 + half[2]));
    const float along_own = o0 * o0 + o1 * o1 + o2 * o2;
    const float own_slab =
        positive(absolute(normal[0] * c0 + normal[1] * c1 + normal[2] * c2 - box.middle_N) -
                 (absolute_normal[0] * h0 + absolute_normal[1] * h1 + absolute_normal[2] * h2 + box.thick));
    const float n0 = nx[i];
    const float n1 = nx[kW + i];
    const float n2 = nx[2 * kW + i];
    const float width = absolute(R[0] * n0 + R[1] * n1 + R[2] * n2) * half[0] +
                        absolute(R[3] * n0 + R[4] * n1 + R[5] * n2) * half[1] +
                        absolute(R[6] * n0 + R[7] * n1 + R[8] * n2) * half[2];
    const float slab =
        positive(absolute(n0 * centre[0] + n1 * centre[1] + n2 * centre[2] - middle[i]) - (width + thick[i]));
    const float both = larger(slab, own_slab);
    squares[i] = larger(larger(along_node, along_own), both * both);
  }
}

}  // namespace

ChildBounds child_bounds() noexcept { return &bounds; }

}  // namespace cellmirror::geometry::CELLMIRROR_KERNELS
