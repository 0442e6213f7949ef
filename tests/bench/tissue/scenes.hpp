// What the benchmarks of tissue simulate: a ball on a fixed foot that sags and swings.
#pragma once

#include <cmath>
#include <numbers>

#include "rt_core/tissue/body/rest_mesh.hpp"
#include "tests/bench/tissue/corotational.hpp"
#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue_bench {

inline constexpr double kElementSize_m = 0.007;
inline const Eigen::Vector3d kGravity(0, 0, -9.81);

// A ball of about so many elements of soft tissue (5 kPa).
inline tissue::ObjectDescription ball_of(double elements) {
  const double volume = elements / 12.0 * std::pow(kElementSize_m, 3);  // twelve tetrahedra a cube
  // Those that reach over the surface count too: about a third of an element's size beyond it.
  const double radius = std::cbrt(volume * 3.0 / (4.0 * std::numbers::pi)) - 0.33 * kElementSize_m;
  tissue::ObjectDescription d = tissue_bodies::ball(radius, kElementSize_m);
  d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(1, 1, -0.7 * radius)});
  d.attributes |= static_cast<std::uint16_t>(TissueAttribute::gravity);
  return d;
}

// One millisecond.
inline void step(tissue::Body& body, int substeps) {
  const double dt = tissue::kStep_s / substeps;
  for (int i = 0; i < substeps; ++i) {
    body.begin_step(dt, kGravity);
    body.end_step(dt);
  }
}

}  // namespace cellmirror::tissue_bench
