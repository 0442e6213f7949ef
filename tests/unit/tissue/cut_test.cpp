// Cuts: what they divide comes apart, volume and surface stay what they were, and a reset undoes them to the bit.
#include <gtest/gtest.h>

#include <random>

#include "rt_core/tissue/body/dissection.hpp"
#include "rt_core/tissue/body/elements.hpp"
#include "rt_core/tissue/body/topology.hpp"
#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

void expect_closed(const Body& body, double volume) {
  const SurfaceSums sums = surface_sums(body);
  EXPECT_LT(sums.area.norm(), 1e-6 * sums.size);
  EXPECT_NEAR(sums.volume, volume, 1e-6 * volume);
  EXPECT_NEAR(body.volume_at_rest(), volume, 1e-6 * volume);
}

// Through all of the ball, across x.
BladeSweep whole_plane(double x) {
  return {.corner = Eigen::Vector3d(x, -0.1, -0.1),
          .along = Eigen::Vector3d(0, 0.2, 0),
          .across = Eigen::Vector3d(0, 0, 0.2)};
}

TEST(TissueCut, APlaneMakesTwoPartsThatSeparate) {
  for (const double at : {0.0, 0.0013, -0.004}) {
    ObjectDescription d = ball(0.03, 0.008);
    d.material.drag_1_s = 0;
    Body body = made(d);
    const double volume = body.volume_at_rest();
    EXPECT_EQ(state_of(body).parts, 1U);
    const std::uint64_t revision = body.revision();
    const CutResult cut = body.cut(whole_plane(at));
    EXPECT_GT(cut.links, 20U);
    EXPECT_GT(cut.elements, 20U);
    EXPECT_NEAR(cut.at.x(), at, 1e-9);
    EXPECT_GT(cut.area_m2, 0.0);
    EXPECT_NE(body.revision(), revision);
    EXPECT_EQ(state_of(body).parts, 2U);
    expect_closed(body, volume);
    // Half go one way, half the other, by a push at surface points.
    for (const EmbeddedPoint& p :
         std::vector<EmbeddedPoint>(body.surface_points().begin(), body.surface_points().end())) {
      const double x = body.position(p).x() - at;
      if (std::abs(x) > 0.01) body.add_impulse(p, Eigen::Vector3d(x > 0 ? 1e-5 : -1e-5, 0, 0));
    }
    const double dt = step_of(body);
    for (int i = 0; i < static_cast<int>(0.3 / dt); ++i) {
      body.begin_step(dt, Eigen::Vector3d::Zero());
      body.end_step(dt);
    }
    double right = 1;
    double left = -1;
    for (const Eigen::Vector3d& p : body.surface_positions()) {
      if (p.x() > 0) right = std::min(right, p.x());
      if (p.x() < 0) left = std::max(left, p.x());
    }
    EXPECT_GT(right - left, 0.002) << "the parts hang together";
  }
}

TEST(TissueCut, AStrokeThatMissesAndOneThatIsNoneChangeNothing) {
  Body body = made(ball(0.03, 0.01));
  const std::uint64_t revision = body.revision();
  EXPECT_EQ(body.cut(whole_plane(0.05)).links, 0U);
  EXPECT_EQ(body.cut({}).links, 0U);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(body.cut({.corner = {nan, 0, 0}, .along = {0, 1, 0}, .across = {0, 0, 1}}).links, 0U);
  EXPECT_EQ(body.cut({.corner = {0, 0, 0}, .along = {nan, 1, 0}, .across = {0, 0, 1}}).links, 0U);
  BladeSweep cold = whole_plane(0);
  cold.min_burn = 0.5;
  EXPECT_EQ(body.cut(cold).links, 0U);
  EXPECT_EQ(body.revision(), revision);
}

TEST(TissueCut, TheSameStrokeDividesOnce) {
  Body body = made(ball(0.03, 0.01));
  EXPECT_GT(body.cut(whole_plane(0.001)).links, 0U);
  EXPECT_EQ(body.cut(whole_plane(0.001)).links, 0U);
}

TEST(TissueCut, ManyStrokesKeepVolumeAndSurface) {
  for (const ObjectDescription& d : {ball(0.03, 0.01), block(Eigen::Vector3d(0.04, 0.04, 0.04), {4, 4, 4})}) {
    Body body = made(d);
    const double volume = body.volume_at_rest();
    const std::size_t elements = state_of(body).elements;
    std::mt19937 random(5);
    for (int i = 0; i < 60; ++i) {
      body.cut(random_sweep(random, 0.03));
      if (i % 10 == 9) expect_closed(body, volume);
      ASSERT_LE(state_of(body).elements, 4 * elements);
      ASSERT_LE(body.positions().size(), 16 * elements);
    }
    // Deformed it is still closed, if not of the same volume.
    const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
    place(body, 0.001, [&](std::uint32_t n, const Eigen::Vector3d&) -> Eigen::Vector3d {
      return start[n] + 0.003 * Eigen::Vector3d(std::sin(5.0 * n), std::sin(3.0 * n), std::sin(7.0 * n));
    });
    const SurfaceSums sums = surface_sums(body);
    EXPECT_LT(sums.area.norm(), 1e-6 * sums.size);
  }
}

TEST(TissueCut, NoElementIsEverInvertedAtRestOrWithoutMaterial) {
  const TetraMesh volume = box(Eigen::Vector3d(0.04, 0.04, 0.04), {3, 3, 3});
  const RestMesh mesh = make_rest_mesh(volume.nodes, volume.tetrahedra, {});
  Topology topology(mesh);
  Elements elements(mesh, topology, std::vector<Material>(volume.tetrahedra.size()), kStep_s);
  const double mass = elements.mass();
  std::mt19937 random(8);
  std::uniform_int_distribution<std::uint32_t> edge(0, static_cast<std::uint32_t>(mesh.edges.size() - 1));
  std::uniform_real_distribution<double> share(-0.2, 1.2);  // beyond the ends too
  for (int i = 0; i < 100; ++i) {
    std::vector<Topology::Division> divisions;
    for (int k = 0; k < 12; ++k) divisions.push_back({.edge = edge(random), .share = share(random)});
    TopologyChange change;
    topology.divide(mesh, divisions, change);
    ASSERT_EQ(change.origins.size(), change.new_elements);
    elements.follow(mesh, topology, change.elements, change.origins);
    double sum = 0;
    for (std::uint32_t e = 0; e < elements.states().size(); ++e) {
      const ElementState& s = elements.states()[e];
      ASSERT_GT(s.inverse_shape.determinant(), 0.0);
      ASSERT_GT(s.volume, 0.0);
      ASSERT_NEAR(s.volume, material_volume(mesh, topology, e), 1e-15);
      sum += s.volume;
    }
    ASSERT_NEAR(sum, 0.04 * 0.04 * 0.04, 1e-12);
  }
  EXPECT_NEAR(elements.mass(), mass, 0.05 * mass);  // small parts are kept from having none
  for (std::uint32_t e = 0; e < topology.elements().size(); ++e) {
    for (const std::uint32_t node : topology.elements()[e].nodes) ASSERT_LT(node, topology.rest_node().size());
  }
}

TEST(TissueCut, CopiesOfAFixedNodeAreFree) {
  ObjectDescription d = block(Eigen::Vector3d(0.04, 0.02, 0.02), {8, 4, 4});
  d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(0.001, 1, 1)});
  d.attributes |= static_cast<std::uint16_t>(TissueAttribute::gravity);
  Body body = made(d);
  EXPECT_GT(body.cut({.corner = {0.0025, -0.1, -0.1}, .along = {0, 0.2, 0}, .across = {0, 0, 0.2}}).links, 0U);
  std::size_t fixed = 0;
  for (const double inverse : body.inverse_masses()) fixed += inverse == 0 ? 1U : 0U;
  EXPECT_EQ(fixed, 25U);
  const double dt = step_of(body);
  const EmbeddedPoint end = body.embed_at_rest(Eigen::Vector3d(0.039, 0.01, 0.01));
  EmbeddedPoint followed = end;
  body.follow_cuts(followed);
  for (int i = 0; i < static_cast<int>(0.3 / dt); ++i) {
    body.begin_step(dt, Eigen::Vector3d(0, 0, -9.81));
    body.end_step(dt);
  }
  // All of the other part falls: 0.5 g t^2, less the drag.
  EXPECT_LT(body.position(followed).z(), 0.01 - 0.35);
}

TEST(TissueCut, PointsThatAreKeptStayWhereTheyAre) {
  Body body = made(ball(0.03, 0.008));
  std::vector<EmbeddedPoint> points;
  std::vector<Eigen::Vector3d> at;
  for (const EmbeddedPoint& p : body.surface_points()) {
    points.push_back(p);
    at.push_back(body.position(p));
  }
  std::mt19937 random(11);
  for (int i = 0; i < 20; ++i) body.cut(random_sweep(random, 0.03));
  for (std::size_t i = 0; i < points.size(); ++i) {
    body.follow_cuts(points[i]);
    EXPECT_LT((body.position(points[i]) - at[i]).norm(), 1e-9);
    for (const std::uint32_t node : points[i].node) ASSERT_LT(node, body.positions().size());
  }
}

TEST(TissueCut, ResetRestoresToTheBit) {
  ObjectDescription d = ball(0.03, 0.01);
  d.attributes |=
      static_cast<std::uint16_t>(TissueAttribute::gravity) | static_cast<std::uint16_t>(TissueAttribute::plastic);
  d.material.yield_strain = 0.05;
  d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(1, 1, -0.015)});
  Body body = made(d);
  Body fresh = made(d);
  const double dt = step_of(body);
  const auto act = [&](Body& b) {
    std::mt19937 random(3);
    for (int i = 0; i < 40; ++i) {
      b.begin_step(dt, Eigen::Vector3d(0, 0, -9.81));
      b.end_step(dt);
      if (i % 8 == 0) b.cut(random_sweep(random, 0.03));
      if (i % 8 == 4) b.heat(Eigen::Vector3d(0, 0, 0.03), Eigen::Vector3d(0, 0.02, 0.02), 0.02, 0.3);
    }
  };
  act(body);
  EXPECT_GT(state_of(body).elements, state_of(fresh).elements);
  body.reset();
  for (int round = 0; round < 2; ++round) {
    ASSERT_EQ(body.positions().size(), fresh.positions().size());
    for (std::size_t n = 0; n < body.positions().size(); ++n) {
      ASSERT_EQ(body.positions()[n], fresh.positions()[n]);
      ASSERT_EQ(body.velocities()[n], fresh.velocities()[n]);
      ASSERT_EQ(body.inverse_masses()[n], fresh.inverse_masses()[n]);
    }
    ASSERT_EQ(body.surface_triangles().size(), fresh.surface_triangles().size());
    for (std::size_t t = 0; t < body.surface_triangles().size(); ++t) {
      ASSERT_EQ(body.surface_triangles()[t], fresh.surface_triangles()[t]);
    }
    EXPECT_EQ(state_of(body).energy_j, state_of(fresh).energy_j);
    // And it goes on as a new body does.
    if (round == 0) {
      act(body);
      act(fresh);
    }
  }
}

}  // namespace
}  // namespace cellmirror::tissue
