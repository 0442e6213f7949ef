// Heat, tears and lasting stretches.
#include <gtest/gtest.h>

#include "rt_core/tissue/body/elements.hpp"
#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

constexpr auto kTear = static_cast<std::uint16_t>(TissueAttribute::tear);
constexpr auto kPlastic = static_cast<std::uint16_t>(TissueAttribute::plastic);

// Stretches along x from the end at 0, with the other directions kept.
void stretch(Body& body, const std::vector<Eigen::Vector3d>& start, double factor) {
  place(body, 0.001, [&](std::uint32_t n, const Eigen::Vector3d&) {
    return Eigen::Vector3d(factor * start[n].x(), start[n].y(), start[n].z());
  });
}

TEST(TissueHeat, StiffensAndShrinksAndStaysStable) {
  Body body = made(ball(0.03, 0.008));
  const double dt = step_of(body);
  const double volume = surface_sums(body).volume;
  const EmbeddedPoint middle = body.embed_at_rest(Eigen::Vector3d::Zero());
  EXPECT_EQ(body.burn(middle), 0.0);
  double changed = 0;
  double largest = 0;
  for (int i = 0; i < 100; ++i) {
    changed += body.heat(Eigen::Vector3d(0, 0, -0.03), Eigen::Vector3d(0, 0, 0.03), 0.2, 0.02);
    const double energy = step_energy(body, dt);
    largest = std::max(largest, energy);
    ASSERT_TRUE(std::isfinite(energy));
  }
  EXPECT_NEAR(body.burn(middle), 2.0, 0.1);
  EXPECT_NEAR(changed, body.volume_at_rest(), 0.02 * changed);
  EXPECT_NEAR(state_of(body).coagulated_share, 1.0, 0.01);
  for (int i = 0; i < static_cast<int>(3.0 / dt); ++i) {
    const double energy = step_energy(body, dt);
    ASSERT_LE(energy, 1.1 * largest);
  }
  // Free to shrink, it becomes smaller by the shrinking in each direction and then is without stress.
  const double left = (1.0 - kBurntShrinking) * (1.0 - kBurntShrinking) * (1.0 - kBurntShrinking);
  EXPECT_NEAR(surface_sums(body).volume, left * volume, 0.01 * volume);
  EXPECT_LT(body.elastic_energy(), 0.02 * largest);
}

TEST(TissueHeat, StiffensFiveTimes) {
  ObjectDescription d = block(Eigen::Vector3d(0.04, 0.01, 0.01), {4, 1, 1});
  d.material.damping_s = 0;
  Body raw = made(d);
  Body burnt = made(d);
  burnt.heat(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.04, 0, 0), 10.0, 1.0);
  burnt.heat(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.04, 0, 0), 10.0, 1.0);
  const std::vector<Eigen::Vector3d> start(raw.positions().begin(), raw.positions().end());
  stretch(raw, start, 1.01);
  // The same stretch of what it has shrunk to.
  const double shrunk = 1.0 - kBurntShrinking;
  place(burnt, 0.001, [&](std::uint32_t n, const Eigen::Vector3d&) -> Eigen::Vector3d {
    return shrunk * Eigen::Vector3d(1.01 * start[n].x(), start[n].y(), start[n].z());
  });
  EXPECT_NEAR(burnt.elastic_energy() / raw.elastic_energy(), 1.0 + kBurntStiffening, 0.02);
}

TEST(TissueHeat, ReachesAsFarAsItsRadiusAndABladeCutsOnlyWhatIsBurnt) {
  Body body = made(ball(0.03, 0.008));
  body.heat(Eigen::Vector3d(0, 0, 0.03), Eigen::Vector3d(0, 0, 0.03), 0.015, 5.0);
  EXPECT_EQ(body.burn(body.embed_at_rest(Eigen::Vector3d(0, 0, -0.02))), 0.0);
  EXPECT_GT(body.burn(body.embed_at_rest(Eigen::Vector3d(0, 0, 0.027))), 1.0);
  BladeSweep blade{.corner = {0.0011, -0.1, -0.1}, .along = {0, 0.2, 0}, .across = {0, 0, 0.2}, .min_burn = 1.0};
  const CutResult hot = body.cut(blade);
  EXPECT_GT(hot.links, 0U);
  EXPECT_GT(hot.at.z(), 0.015);
  EXPECT_EQ(state_of(body).parts, 1U);
}

TEST(TissueTear, HappensBeyondTheLimitOnly) {
  ObjectDescription d = block(Eigen::Vector3d(0.04, 0.01, 0.01), {8, 2, 2});
  d.attributes |= kTear;
  d.material.tear_strain = 0.5;
  Body body = made(d);
  const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
  const auto tears = [&] {
    std::uint32_t links = 0;
    for (int i = 0; i < 16; ++i) links += body.tear(20).links;
    return links;
  };
  stretch(body, start, 1.49);
  EXPECT_EQ(tears(), 0U);
  stretch(body, start, 1.51);
  EXPECT_LE(body.tear(20).links, 20U);
  EXPECT_GT(tears(), 0U);
  EXPECT_NEAR(body.volume_at_rest(), 4e-6, 1e-11);
}

TEST(TissueYield, StretchBeyondTheLimitStays) {
  ObjectDescription d = block(Eigen::Vector3d(0.04, 0.01, 0.01), {8, 2, 2});
  d.attributes |= kPlastic;
  d.material.yield_strain = 0.2;
  d.material.drag_1_s = 40;
  Body body = made(d);
  const double dt = step_of(body);
  const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
  const auto settled_length = [&](double factor) {
    stretch(body, start, factor);
    body.begin_step(dt, Eigen::Vector3d::Zero());  // the strain of which yielding is judged
    for (std::uint32_t n = 0; n < start.size(); ++n) body.add_velocity(n, -body.velocities()[n]);
    body.end_step(dt);
    for (int i = 0; i < static_cast<int>(3.0 / dt); ++i) {
      body.begin_step(dt, Eigen::Vector3d::Zero());
      body.end_step(dt);
    }
    double low = 1;
    double high = -1;
    for (const Eigen::Vector3d& p : body.positions()) {
      low = std::min(low, p.x());
      high = std::max(high, p.x());
    }
    return high - low;
  };
  EXPECT_NEAR(settled_length(1.15), 0.04, 1e-4);
  EXPECT_GT(settled_length(1.6), 0.046);
  EXPECT_NEAR(body.volume_at_rest(), 4e-6, 1e-11);
}

TEST(TissueYield, ShapesAtRestStaySoundHoweverOftenTheyYield) {
  const TetraMesh volume = box(Eigen::Vector3d(0.01, 0.01, 0.01), {1, 1, 1});
  const RestMesh mesh = make_rest_mesh(volume.nodes, volume.tetrahedra, {});
  const Topology topology(mesh);
  Material material;
  material.yield_strain = 0.1;
  Elements elements(mesh, topology, std::vector<Material>(volume.tetrahedra.size(), material), kStep_s);
  std::vector<double> before;
  for (const ElementState& s : elements.states()) before.push_back(s.inverse_shape.determinant());
  std::vector<Eigen::Vector3d> x(mesh.nodes.size());
  std::vector<Eigen::Vector3d> f(mesh.nodes.size(), Eigen::Vector3d::Zero());
  std::uint32_t yielded = 0;
  for (int i = 0; i < 200; ++i) {
    for (std::size_t n = 0; n < x.size(); ++n) {
      x[n] = mesh.nodes[topology.rest_node()[n]];
      x[n].x() *= 1.0 + 0.1 * i;
    }
    elements.add_forces(x, kStep_s, f);
    yielded += elements.yield(topology, x);
  }
  EXPECT_GT(yielded, 6U);
  for (std::size_t e = 0; e < before.size(); ++e) {
    EXPECT_NEAR(elements.states()[e].inverse_shape.determinant(), before[e], 1e-6 * before[e]);
  }
  EXPECT_LT(elements.added_mass(), 16 * elements.mass());
}

}  // namespace
}  // namespace cellmirror::tissue
