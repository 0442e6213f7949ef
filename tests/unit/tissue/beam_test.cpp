// A cantilever that bends a little, against Timoshenko's beam.
#include <gtest/gtest.h>

#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

constexpr double kLength = 0.1;  // m
constexpr double kHeight = 0.02;
constexpr double kLoad = 1e-3;  // N
constexpr double kModulus = 2e4;
constexpr double kRatio = 0.3;

double timoshenko() {
  const double area = kHeight * kHeight;
  const double inertia = area * area / 12.0;
  const double shear = kModulus / (2.0 * (1.0 + kRatio));
  const double kappa = 10.0 * (1.0 + kRatio) / (12.0 + 11.0 * kRatio);
  return kLoad * kLength * kLength * kLength / (3.0 * kModulus * inertia) + kLoad * kLength / (kappa * shear * area);
}

// Deflection of the end's middle, m.
double deflection(int across) {
  ObjectDescription d = block(Eigen::Vector3d(kLength, kHeight, kHeight), {5 * across, across, across});
  d.material = {
      .youngs_modulus_pa = kModulus, .poissons_ratio = kRatio, .density_kg_m3 = 1000, .damping_s = 0, .drag_1_s = 20};
  d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(1e-6, 1, 1)});
  Body body = made(d);
  const double dt = step_of(body);
  const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
  // As a stress on the end would be: each square gives a quarter to its corners.
  std::vector<std::pair<std::uint32_t, double>> loads;
  const auto at_side = [&](double v) { return v < 1e-6 || v > kHeight - 1e-6; };
  for (std::uint32_t n = 0; n < start.size(); ++n) {
    if (start[n].x() < kLength - 1e-6) continue;
    const double share = (at_side(start[n].y()) ? 0.5 : 1.0) * (at_side(start[n].z()) ? 0.5 : 1.0);
    loads.emplace_back(n, -kLoad * share / (across * across));
  }
  const EmbeddedPoint end = body.embed_at_rest(Eigen::Vector3d(kLength, kHeight / 2, kHeight / 2));
  for (int i = 0; i < static_cast<int>(2.5 / dt); ++i) {
    for (const auto& [node, force] : loads) body.add_force(node, Eigen::Vector3d(0, 0, force));
    body.begin_step(dt, Eigen::Vector3d::Zero());
    body.end_step(dt);
  }
  EXPECT_LT(body.largest_speed(), 5e-5);
  return kHeight / 2 - body.position(end).z();
}

TEST(TissueBeam, DeflectsAsTimoshenkoSaysTheMoreExactlyTheFinerItIs) {
  double before = 1;
  for (const int across : {2, 4, 8}) {
    const double error = std::abs(deflection(across) / timoshenko() - 1.0);
    RecordProperty("error_with_" + std::to_string(across), std::to_string(error));
    EXPECT_LT(error, 0.6 * before) << across;
    before = error;
  }
  EXPECT_LT(before, 0.1);
}

}  // namespace
}  // namespace cellmirror::tissue
