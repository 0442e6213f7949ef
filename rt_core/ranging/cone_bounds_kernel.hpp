// The bounds of cone_bounds.hpp for eight boxes at once. Included by one source for each instruction set, which defines
// CELLMIRROR_KERNELS as the namespace of its own. Nothing inline of a library is used: the linker would merge code of
// different instruction sets.
#pragma once

#include <cstddef>

#include "rt_core/geometry/float_lanes.hpp"
#include "rt_core/ranging/cone_bounds.hpp"

namespace cellmirror::ranging::CELLMIRROR_KERNELS {

namespace {

using geometry::Eight;
using geometry::WideNode;

// Arrays are read through plain pointers: std::array's own access is an inline function of a library.
template <class Array>
CELLMIRROR_LANE const float* numbers(const Array& array) {
  return reinterpret_cast<const float*>(&array);
}

CELLMIRROR_LANE Eight root(const Eight& a) noexcept {
  Eight out;
  constexpr unsigned kLanes = sizeof(geometry::FloatRegister) / sizeof(float);
  for (unsigned i = 0; i < Eight::kRegisters; ++i) {
    for (unsigned k = 0; k < kLanes; ++k) out.part[i][k] = __builtin_sqrtf(a.part[i][k]);
  }
  return out;
}

CELLMIRROR_LANE Eight or_else(const Eight& a, const Eight& greater, const Eight& than, float value) noexcept {
  Eight out;
  const Eight other = geometry::same(value);
  for (unsigned i = 0; i < Eight::kRegisters; ++i) {
    out.part[i] = greater.part[i] > than.part[i] ? other.part[i] : a.part[i];
  }
  return out;
}

// A box is beside the cone where it lies beyond the plane that touches the cone along the line nearest to the box's
// centre. The plane's normal is taken times the centre's distance from the cone's axis, which saves a division.
void bounds(const WideNode& node, const SingleCone& cone, float* squares) noexcept {
  constexpr std::size_t kW = WideNode::kWidth;
  const float* const c = numbers(node.centre);
  const float* const h = numbers(node.half);
  const float* const u = numbers(node.axes);
  const float* const o = numbers(cone.apex);
  const float* const a = numbers(cone.axis);
  const Eight d0 = geometry::load(c) - o[0];
  const Eight d1 = geometry::load(c + kW) - o[1];
  const Eight d2 = geometry::load(c + 2 * kW) - o[2];
  const Eight along = a[0] * d0 + a[1] * d1 + a[2] * d2;
  const Eight out0 = d0 - a[0] * along;
  const Eight out1 = d1 - a[1] * along;
  const Eight out2 = d2 - a[2] * along;
  const Eight squared_across = out0 * out0 + out1 * out1 + out2 * out2;
  const Eight lean = cone.sine * root(squared_across);
  const Eight n0 = cone.cosine * out0 - a[0] * lean;
  const Eight n1 = cone.cosine * out1 - a[1] * lean;
  const Eight n2 = cone.cosine * out2 - a[2] * lean;
  const Eight beyond = cone.cosine * squared_across - lean * along;
  Eight reach = geometry::same(cone.margin);
  Eight square = geometry::same(0);
#pragma GCC unroll 3
  for (std::size_t k = 0; k < 3; ++k) {
    const Eight u0 = geometry::load(u + (3 * k) * kW);
    const Eight u1 = geometry::load(u + (3 * k + 1) * kW);
    const Eight u2 = geometry::load(u + (3 * k + 2) * kW);
    const Eight half = geometry::load(h + k * kW);
    const Eight gap = geometry::positive(geometry::absolute(d0 * u0 + d1 * u1 + d2 * u2) - half);
    square = square + gap * gap;
    reach = reach + geometry::absolute(n0 * u0 + n1 * u1 + n2 * u2) * half;
  }
  geometry::store(or_else(square, beyond, reach, kBesideCone), squares);
}

}  // namespace

ConeKernels cone_kernels() noexcept { return {&bounds}; }

}  // namespace cellmirror::ranging::CELLMIRROR_KERNELS
