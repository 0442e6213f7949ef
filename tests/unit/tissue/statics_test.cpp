// Patch test: where the displacement is affine, forces at inner nodes vanish.
#include <gtest/gtest.h>

#include <random>

#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

TEST(TissueStatics, ForcesOnInnerNodesVanishWhereTheDisplacementIsAffine) {
  ObjectDescription d = block(Eigen::Vector3d(0.06, 0.05, 0.04), {6, 5, 4});
  d.material.damping_s = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto inner = [](const Eigen::Vector3d& p) {
    return p.x() > 1e-6 && p.x() < 0.06 - 1e-6 && p.y() > 1e-6 && p.y() < 0.05 - 1e-6 && p.z() > 1e-6 &&
           p.z() < 0.04 - 1e-6;
  };
  for (Eigen::Vector3d& p : d.volume.nodes) {
    if (inner(p)) p += 0.002 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  }
  const std::vector<Eigen::Vector3d> rest = d.volume.nodes;
  Body body = made(d);
  const double dt = step_of(body);
  Eigen::Matrix3d f;
  f << 1.3, 0.2, -0.1, 0.05, 0.8, 0.3, 0.15, -0.2, 1.1;
  f = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()) * f;
  std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
  place(body, dt, [&](std::uint32_t n, const Eigen::Vector3d&) -> Eigen::Vector3d { return f * start[n]; });
  body.begin_step(dt, Eigen::Vector3d::Zero());
  double at_boundary = 0;
  double within = 0;
  std::size_t inner_nodes = 0;
  for (std::size_t n = 0; n < start.size(); ++n) {
    double& largest = inner(start[n]) ? within : at_boundary;
    inner_nodes += inner(start[n]) ? 1U : 0U;
    largest = std::max(largest, body.internal_forces()[n].norm());
  }
  EXPECT_EQ(inner_nodes, 5U * 4U * 3U);
  EXPECT_GT(at_boundary, 1e-2);
  EXPECT_LT(within, 1e-5 * at_boundary);
}

TEST(TissueStatics, ARigidMotionTakesNoForceAndNoEnergy) {
  ObjectDescription d = block(Eigen::Vector3d(0.06, 0.05, 0.04), {4, 4, 4});
  d.material.damping_s = 0;
  Body body = made(d);
  const double dt = step_of(body);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
  place(body, dt, [&](std::uint32_t n, const Eigen::Vector3d&) -> Eigen::Vector3d {
    return turn * start[n] + Eigen::Vector3d(3, 2, 1);
  });
  body.begin_step(dt, Eigen::Vector3d::Zero());
  for (const Eigen::Vector3d& force : body.internal_forces()) EXPECT_LT(force.norm(), 1e-6);
  EXPECT_LT(body.elastic_energy(), 1e-10);
}

}  // namespace
}  // namespace cellmirror::tissue
