// Forward kinematics and Jacobian on plain numbers. Included by one source for each instruction set, which defines
// CELLMIRROR_KERNELS as the namespace of its own. Everything here has internal linkage, and no inline function of a
// library is used: the linker would otherwise merge code of different instruction sets.
#pragma once

#include <cstddef>

#include "rt_core/kinematics/forward_constants.hpp"
#include "rt_core/kinematics/lanes.hpp"
#include "rt_core/kinematics/sincos.hpp"

namespace cellmirror::kinematics::CELLMIRROR_KERNELS {

namespace {

// Of the first three lanes; the last one is zero where that of `a` or `b` is.
CELLMIRROR_LANES void cross(const Four& a, const Four& b, Four& out) noexcept {
  Four a_turned;
  Four b_turned;
  turn_lanes(a, a_turned);
  turn_lanes(b, b_turned);
  turn_lanes(a * b_turned - a_turned * b, out);
}

// N: number of joints, 0: any.
template <std::size_t N>
struct Sizes {
  static constexpr std::size_t kCapacity = sincos_capacity(N > 0 ? N : kMaxChainJoints);
};

CELLMIRROR_LANES void write_column(const ForwardConstants::Joint& joint, const Four& axis, const Four& arm,
                                   double* column) noexcept {
  Four linear = axis;
  Four angular = axis - axis;
  if (!joint.prismatic) {
    cross(axis, arm, linear);
    angular = axis;
  }
  store_threes(linear, angular, column);
}

template <std::size_t N>
CELLMIRROR_LANES void write_jacobian(const ForwardConstants& chain, const Four* axis, const Four* origin,
                                     const Four& tip, double* jacobian) noexcept {
  const std::size_t joints = N > 0 ? N : chain.joints;
  if (chain.plain) {
    for (std::size_t i = 0; i < joints; ++i) write_column(chain.joint[i], axis[i], tip - origin[i], jacobian + 6 * i);
    return;
  }
  for (std::size_t k = 0; k < 6 * chain.variables; ++k) jacobian[k] = 0;
  for (std::size_t i = 0; i < joints; ++i) {
    double column[6];
    write_column(chain.joint[i], axis[i], tip - origin[i], column);
    for (std::size_t k = 0; k < 6; ++k) jacobian[6 * chain.joint[i].variable + k] += chain.joint[i].factor * column[k];
  }
}

// Of the joints i to i + 3; zero beyond the last one. Made in registers: a load of four values right after they were
// stored one by one would wait for the stores.
template <std::size_t N>
CELLMIRROR_LANES void values_of(const ForwardConstants& chain, const double* q, std::size_t i, Four& values) noexcept {
  const std::size_t joints = N > 0 ? N : chain.joints;
  if (chain.plain && i + 4 <= joints) {
    load(q + i, values);
    return;
  }
  double value[4];
  for (std::size_t k = 0; k < 4; ++k) {
    value[k] = i + k < joints ? q[chain.plain ? i + k : chain.joint[i + k].variable] : 0.0;
  }
  set(values, value[0], value[1], value[2], value[3]);
}

template <std::size_t N, bool kJacobian>
void walk(const ForwardConstants& chain, const double* q, double* X_BT, double* jacobian) noexcept {
  constexpr std::size_t kCapacity = Sizes<N>::kCapacity;
  const std::size_t joints = N > 0 ? N : chain.joints;
  alignas(32) double value[kCapacity];
  alignas(32) double angle[kCapacity];
  alignas(32) double sine[kCapacity];
  alignas(32) double cosine[kCapacity];
  Four axis[kJacobian ? kCapacity : 1];
  Four origin[kJacobian ? kCapacity : 1];
  for (std::size_t i = 0; i < joints; i += 4) {
    Four values, turn, zero;
    values_of<N>(chain, q, i, values);
    load(&chain.turn[i], turn);
    load(&chain.turn_zero[i], zero);
    store(values, value + i);
    store(turn * values + zero, angle + i);
  }
  sincos_of(angle, joints, sine, cosine);
  Four x, y, z, p;
  load(&chain.X_B0[0], x);
  load(&chain.X_B0[4], y);
  load(&chain.X_B0[8], z);
  load(&chain.X_B0[12], p);
  for (std::size_t i = 0; i < joints; ++i) {
    const ForwardConstants::Joint& joint = chain.joint[i];
    if constexpr (kJacobian) {
      axis[i] = z;
      origin[i] = p;
    }
    const Four x_turned = cosine[i] * x + sine[i] * y;
    const Four y_turned = cosine[i] * y - sine[i] * x;
    p += joint.shift[0] * x_turned + joint.shift[1] * y_turned + (joint.shift[2] + joint.slide * value[i]) * z;
    x = x_turned;
    y = joint.cos_x * y_turned + joint.sin_x * z;
    z = joint.cos_x * z - joint.sin_x * y_turned;
  }
  store(chain.tip_cos * x + chain.tip_sin * y, X_BT);
  store(chain.tip_cos * y - chain.tip_sin * x, X_BT + 4);
  store(z, X_BT + 8);
  store(p, X_BT + 12);
  if constexpr (kJacobian) write_jacobian<N>(chain, axis, origin, p, jacobian);
}

}  // namespace

ForwardKernels forward_kernels() {
  return {{walk<0, false>, walk<1, false>, walk<2, false>, walk<3, false>, walk<4, false>, walk<5, false>,
           walk<6, false>, walk<7, false>, walk<8, false>},
          {walk<0, true>, walk<1, true>, walk<2, true>, walk<3, true>, walk<4, true>, walk<5, true>, walk<6, true>,
           walk<7, true>, walk<8, true>}};
}

}  // namespace cellmirror::kinematics::CELLMIRROR_KERNELS
