// The bounds of box_bounds.hpp for eight boxes at once. Included by one source for each instruction set, which defines
// CELLMIRROR_KERNELS as the namespace of its own. Nothing inline of a library is used: the linker would merge code of
// different instruction sets.
#pragma once

#include "rt_core/geometry/box_bounds.hpp"
#include "rt_core/geometry/float_lanes.hpp"

namespace cellmirror::geometry::CELLMIRROR_KERNELS {

namespace {

// Arrays are read through plain pointers: std::array's own access is an inline function of a library.
template <class Array>
CELLMIRROR_LANE const float* numbers(const Array& array) {
  return reinterpret_cast<const float*>(&array);
}
template <class Array>
CELLMIRROR_LANE float* numbers(Array& array) {
  return reinterpret_cast<float*>(&array);
}
CELLMIRROR_LANE float dot(const float* a, float x, float y, float z) { return a[0] * x + a[1] * y + a[2] * z; }
CELLMIRROR_LANE Eight dot(const float* a, const Eight& x, const Eight& y, const Eight& z) {
  return a[0] * x + a[1] * y + a[2] * z;
}

// Separating axes: the face normals of both boxes, and the direction. The axes of one box are at right angles, so the
// squares of their gaps add up to a bound.
void bounds(const WideNode& node, const BoxQuery& box, float* squares) noexcept {
  constexpr std::size_t kW = WideNode::kWidth;
  const float* const c = numbers(node.centre);
  const float* const h = numbers(node.half);
  const float* const u = numbers(node.axes);
  const float* const q = numbers(box.centre);
  const float* const g = numbers(box.half);
  const float* const x = numbers(box.axes);
  const float* const y = x + 3;
  const float* const z = x + 6;
  const float* const n = numbers(box.direction);
  const Eight d0 = load(c) - q[0];
  const Eight d1 = load(c + kW) - q[1];
  const Eight d2 = load(c + 2 * kW) - q[2];
  Eight of_node = same(0);
  Eight reach_x = same(g[0]);
  Eight reach_y = same(g[1]);
  Eight reach_z = same(g[2]);
  Eight reach_n =
      same(__builtin_fabsf(dot(x, n[0], n[1], n[2])) * g[0] + __builtin_fabsf(dot(y, n[0], n[1], n[2])) * g[1] +
           __builtin_fabsf(dot(z, n[0], n[1], n[2])) * g[2]);
#pragma GCC unroll 3
  for (std::size_t k = 0; k < 3; ++k) {
    const Eight u0 = load(u + (3 * k) * kW);
    const Eight u1 = load(u + (3 * k + 1) * kW);
    const Eight u2 = load(u + (3 * k + 2) * kW);
    const Eight half = load(h + k * kW);
    const Eight with_x = absolute(dot(x, u0, u1, u2));
    const Eight with_y = absolute(dot(y, u0, u1, u2));
    const Eight with_z = absolute(dot(z, u0, u1, u2));
    const Eight reach = g[0] * with_x + g[1] * with_y + g[2] * with_z;
    const Eight gap = positive(absolute(d0 * u0 + d1 * u1 + d2 * u2) - half - reach);
    of_node = of_node + gap * gap;
    reach_x = reach_x + with_x * half;
    reach_y = reach_y + with_y * half;
    reach_z = reach_z + with_z * half;
    reach_n = reach_n + absolute(dot(n, u0, u1, u2)) * half;
  }
  const Eight gap_x = positive(absolute(dot(x, d0, d1, d2)) - reach_x);
  const Eight gap_y = positive(absolute(dot(y, d0, d1, d2)) - reach_y);
  const Eight gap_z = positive(absolute(dot(z, d0, d1, d2)) - reach_z);
  const Eight gap_n = positive(absolute(dot(n, d0, d1, d2)) - reach_n);
  const Eight of_box = gap_x * gap_x + gap_y * gap_y + gap_z * gap_z;
  store(larger(larger(of_node, of_box), gap_n * gap_n), squares);
}

void place_box(const WideNode& node, std::size_t place, const BoxFrame& frame, BoxQuery& box) noexcept {
  constexpr std::size_t kW = WideNode::kWidth;
  const float* const c = numbers(node.centre) + place;
  const float* const h = numbers(node.half) + place;
  const float* const u = numbers(node.axes) + place;
  const float* const R = numbers(frame.R_NO);
  const float* const p = numbers(frame.p_NO);
  float* const centre = numbers(box.centre);
  float* const half = numbers(box.half);
  float* const axes = numbers(box.axes);
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = dot(R + 3 * i, c[0], c[kW], c[2 * kW]) + p[i];
    half[i] = h[i * kW];
    for (std::size_t k = 0; k < 3; ++k) {
      axes[3 * k + i] = dot(R + 3 * i, u[3 * k * kW], u[(3 * k + 1) * kW], u[(3 * k + 2) * kW]);
    }
  }
}

}  // namespace

BoxKernels box_kernels() noexcept { return {&bounds, &place_box}; }

}  // namespace cellmirror::geometry::CELLMIRROR_KERNELS
