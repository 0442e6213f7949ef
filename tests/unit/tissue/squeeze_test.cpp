// Large deformations of the kind that instruments cause: squeezed flat, turned inside out, torn by fast pushes. What
// comes back is the shape at rest, and no energy but what was put in.
#include <gtest/gtest.h>

#include <random>

#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

struct Recovery {
  double start = 0;  // J
  double peak = 0;
  double end = 0;
  double worst = 0;  // m, distance of a node from where it was, rigid motion aside
};

template <class Where>
Recovery recover(const ObjectDescription& d, Where&& where) {
  Body body = made(d);
  const double dt = step_of(body);
  const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
  place(body, dt, [&](std::uint32_t n, const Eigen::Vector3d&) -> Eigen::Vector3d { return where(start[n]); });
  Recovery r;
  r.start = body.elastic_energy();
  for (int i = 0; i < static_cast<int>(1.5 / dt); ++i) {
    const double energy = step_energy(body, dt);
    if (!std::isfinite(energy)) {
      r.peak = energy;
      return r;
    }
    r.peak = std::max(r.peak, energy);
  }
  r.end = step_energy(body, dt);
  for (std::size_t n = 0; n < start.size(); ++n) {
    if (body.inverse_masses()[n] == 0) continue;
    r.worst = std::max(r.worst, (body.positions()[n] - start[n]).norm());
  }
  return r;
}

ObjectDescription held_ball(double youngs_modulus_pa = Material{}.youngs_modulus_pa) {
  ObjectDescription d = ball(0.03, 0.008);
  d.material.youngs_modulus_pa = youngs_modulus_pa;
  d.material.drag_1_s = 10;
  d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(1, 1, -0.02)});
  return d;
}

TEST(TissueSqueeze, ABodyThatIsSqueezedComesBack) {
  for (const double factor : {0.5, 0.3, 0.15}) {
    const Recovery r = recover(held_ball(), [&](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(p.x(), p.y(), factor * (p.z() + 0.03) - 0.03);
    });
    EXPECT_LT(r.peak, 1.1 * r.start) << factor;
    EXPECT_LT(r.end, 0.02 * r.start) << factor;
    EXPECT_LT(r.worst, 0.001) << factor;
  }
}

TEST(TissueSqueeze, ABodyThatIsPulledComesBack) {
  for (const double factor : {1.5, 2.5, 4.0}) {
    const Recovery r = recover(held_ball(), [&](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(p.x(), p.y(), factor * (p.z() + 0.03) - 0.03);
    });
    EXPECT_LT(r.peak, 1.1 * r.start) << factor;
    EXPECT_LT(r.end, 0.02 * r.start) << factor;
    EXPECT_LT(r.worst, 0.001) << factor;
  }
}

// As ligaments and vessel walls are: the waves are fourteen times as fast.
TEST(TissueSqueeze, AStiffBodyComesBackToo) {
  constexpr double kModulus = 1e6;  // Pa
  for (const double factor : {0.2, 4.0}) {
    const Recovery r = recover(held_ball(kModulus), [&](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(p.x(), p.y(), factor * (p.z() + 0.03) - 0.03);
    });
    EXPECT_LT(r.peak, 1.1 * r.start) << factor;
    EXPECT_LT(r.end, 0.02 * r.start) << factor;
    EXPECT_LT(r.worst, 0.001) << factor;
  }
}

TEST(TissueSqueeze, ElementsThatWereTurnedInsideOutFindBack) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const Recovery r = recover(held_ball(), [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const double x = normal(random);
    const double y = normal(random);
    return p + 0.004 * Eigen::Vector3d(x, y, normal(random));
  });
  EXPECT_LT(r.peak, 1.1 * r.start);
  EXPECT_LT(r.end, 0.02 * r.start);
  EXPECT_LT(r.worst, 0.001);
}

}  // namespace
}  // namespace cellmirror::tissue
