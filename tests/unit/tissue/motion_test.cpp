// What a body that nobody touches keeps: momentum, energy, and results between runs and instruction sets.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "rt_core/tissue/body/element_kernel.hpp"
#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   // kg m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // kg m2/s about the origin
};

Momentum momentum_of(const Body& body) {
  Momentum m;
  for (std::size_t n = 0; n < body.positions().size(); ++n) {
    const Eigen::Vector3d p = body.velocities()[n] / body.inverse_masses()[n];
    m.linear += p;
    m.angular += body.positions()[n].cross(p);
  }
  return m;
}

void step(Body& body, double dt) {
  body.begin_step(dt, Eigen::Vector3d::Zero());
  body.end_step(dt);
}

TEST(TissueMotion, AFreeBodyKeepsItsMomentum) {
  for (const bool cut : {false, true}) {
    ObjectDescription d = ball(0.03, 0.008);
    d.material.damping_s = 0;
    d.material.drag_1_s = 0;
    Body body = made(d);
    if (cut) {
      std::mt19937 random(2);
      for (int i = 0; i < 3; ++i) body.cut(random_sweep(random, 0.03));
    }
    // It turns, flies, and swings.
    for (std::uint32_t n = 0; n < body.positions().size(); ++n) {
      const Eigen::Vector3d p = body.positions()[n];
      body.add_velocity(n, Eigen::Vector3d(0.02, -0.01, 0.03) + Eigen::Vector3d(1, 2, 3).cross(p) +
                               Eigen::Vector3d(2.0 * p.x(), -3.0 * p.y(), 0.5 * p.z()));
    }
    const Momentum start = momentum_of(body);
    const double dt = step_of(body);
    for (int i = 0; i < static_cast<int>(10.0 / dt); ++i) step(body, dt);
    const Momentum end = momentum_of(body);
    EXPECT_LT((end.linear - start.linear).norm(), 1e-6 * start.linear.norm());
    EXPECT_LT((end.angular - start.angular).norm(), 1e-6 * start.angular.norm());
  }
}

// The largest growth from any earlier value, as a share of the largest value.
double growth_of_energy(Body& body, double seconds) {
  const double dt = step_of(body);
  double least = std::numeric_limits<double>::infinity();
  double peak = 0;
  double growth = 0;
  for (int i = 0; i < static_cast<int>(seconds / dt); ++i) {
    const double energy = step_energy(body, dt);
    if (!std::isfinite(energy)) return std::numeric_limits<double>::infinity();
    growth = std::max(growth, energy - least);
    least = std::min(least, energy);
    peak = std::max(peak, energy);
  }
  return growth / peak;
}

TEST(TissueMotion, EnergyDoesNotGrowWithoutInput) {
  for (const double youngs_modulus : {1e3, 5e3, 5e4, 1e6}) {
    for (const bool lattice : {true, false}) {
      ObjectDescription d = lattice ? ball(0.03, 0.008) : block(Eigen::Vector3d(0.06, 0.03, 0.03), {10, 5, 5});
      d.material.youngs_modulus_pa = youngs_modulus;
      Body body = made(d);
      // Stretched and twisted, then left alone.
      const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
      place(body, step_of(body), [&](std::uint32_t n, const Eigen::Vector3d&) -> Eigen::Vector3d {
        const Eigen::Vector3d& p = start[n];
        return Eigen::AngleAxisd(10.0 * p.x(), Eigen::Vector3d::UnitX()) *
               Eigen::Vector3d(1.2 * p.x(), p.y(), 0.9 * p.z());
      });
      EXPECT_LT(growth_of_energy(body, 1.0), 1e-3) << youngs_modulus << (lattice ? ", lattice" : ", tetrahedra");
    }
  }
}

// What a scene gives up for time: it swings more slowly, and hangs where it did.
TEST(TissueMotion, FewerSubstepsTakeMassAndChangeNoRest) {
  std::vector<Eigen::Vector3d> rest;
  for (const int most : {4, 2}) {
    ObjectDescription d = ball(0.02, 0.005);
    d.material.youngs_modulus_pa = 8000;
    d.material.drag_1_s = 20;
    d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, 0.01), .high = Eigen::Vector3d(1, 1, 1)});
    d.most_substeps = most;
    Body sut = made(d);
    const TissueObjectState state = state_of(sut);
    EXPECT_EQ(state.substeps > 2U, most == 4);
    EXPECT_EQ(state.added_mass_share > 0.5, most == 2) << state.added_mass_share;
    const double dt = step_of(sut);
    for (int i = 0; i < static_cast<int>(3.0 / dt); ++i) {
      sut.begin_step(dt, Eigen::Vector3d(0, 0, -9.81));
      sut.end_step(dt);
    }
    EXPECT_LT(sut.largest_speed(), 1e-4);
    if (rest.empty()) {
      rest.assign(sut.positions().begin(), sut.positions().end());
      continue;
    }
    for (std::size_t n = 0; n < rest.size(); ++n) EXPECT_LT((sut.positions()[n] - rest[n]).norm(), 1e-5);
  }
}

TEST(TissueMotion, TwoInstructionSetsAgreeAndOneRepeatsToTheBit) {
  const auto run = [](const std::string& target) {
    EXPECT_TRUE(force_simd_target(target));
    ObjectDescription d = ball(0.03, 0.008);
    d.attributes |= static_cast<std::uint16_t>(TissueAttribute::gravity);
    d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(1, 1, -0.02)});
    Body body = made(d);
    const double dt = step_of(body);
    std::mt19937 random(2);
    for (int i = 0; i < static_cast<int>(2.0 / dt); ++i) {
      if (i % 400 == 0) body.cut(random_sweep(random, 0.03));
      body.begin_step(dt, Eigen::Vector3d(0, 1, -9.81));
      body.end_step(dt);
    }
    force_simd_target({});
    return std::vector<Eigen::Vector3d>(body.positions().begin(), body.positions().end());
  };
  const std::string best(simd_target());
  const std::vector<Eigen::Vector3d> first = run(best);
  const std::vector<Eigen::Vector3d> again = run(best);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t n = 0; n < first.size(); ++n) ASSERT_EQ(first[n], again[n]);
  int others = 0;
  for (const char* name : {"SSE2", "SSSE3", "SSE4", "AVX2", "NEON", "EMU128"}) {
    if (name == best || !force_simd_target(name)) continue;
    ++others;
    const std::vector<Eigen::Vector3d> other = run(name);
    ASSERT_EQ(first.size(), other.size());
    double largest = 0;
    for (std::size_t n = 0; n < first.size(); ++n) largest = std::max(largest, (first[n] - other[n]).norm());
    EXPECT_LT(largest, 1e-6) << name << " and " << best;
  }
  if (others == 0) GTEST_SKIP() << "skipped: this processor has one instruction set only";
}

}  // namespace
}  // namespace cellmirror::tissue
