// After any cuts a body is stable: energy does not grow, and nothing leaves the bounds of memory.
#include <gtest/gtest.h>

#include <random>

#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

// Cuts, shakes the body a little and lets it swing; a mode that is not stable grows from any noise.
void expect_stable_after_cuts(const ObjectDescription& d, unsigned seed, int cuts_at_once) {
  SCOPED_TRACE(d.name + ", " + std::to_string(seed));
  Body body = made(d);
  const double volume = body.volume_at_rest();
  const double dt = step_of(body);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 6; ++round) {
    for (int i = 0; i < cuts_at_once; ++i) body.cut(random_sweep(random, 0.03));
    ASSERT_NEAR(body.volume_at_rest(), volume, 1e-6 * volume);
    ASSERT_LE(state_of(body).elements, 4 * state_of(body).elements_at_start);
    for (std::uint32_t n = 0; n < body.positions().size(); ++n) {
      body.add_velocity(n, 0.01 * Eigen::Vector3d(normal(random), normal(random), normal(random)));
    }
    double peak = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < static_cast<int>(0.15 / dt); ++i) {
      const double energy = step_energy(body, dt);
      ASSERT_TRUE(std::isfinite(energy));
      peak = std::max(peak, energy);
      ASSERT_LT(energy - least, 0.05 * peak) << "round " << round << ", step " << i;
      least = std::min(least, energy);
    }
  }
}

TEST(TissueRandomCuts, LeaveTheBodyStable) {
  for (const unsigned seed : {1U, 2U}) {
    expect_stable_after_cuts(ball(0.03, 0.008), seed, 1);
    expect_stable_after_cuts(ball(0.03, 0.008), seed, 20);
    expect_stable_after_cuts(block(Eigen::Vector3d(0.05, 0.05, 0.05), {6, 6, 6}), seed, 4);
  }
}

TEST(TissueRandomCuts, LeaveBodiesStableThatNeedMass) {
  for (const unsigned seed : {1U, 2U}) {
    ObjectDescription hard = ball(0.03, 0.008);
    hard.name = "hard";
    hard.material.youngs_modulus_pa = 3e5;
    expect_stable_after_cuts(hard, seed, 4);
    ObjectDescription mixed = ball(0.03, 0.008);
    mixed.name = "mixed";
    mixed.regions.push_back({.name = "vessel", .a = {-0.1, 0, 0}, .b = {0.1, 0, 0}, .radius_m = 0.006, .material = {}});
    mixed.regions[0].material.youngs_modulus_pa = 2e5;
    expect_stable_after_cuts(mixed, seed, 4);
  }
}

}  // namespace
}  // namespace cellmirror::tissue
