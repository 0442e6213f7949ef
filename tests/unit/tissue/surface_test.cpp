// The lattice fills a surface, and the body's own surface is closed and encloses its material.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

void expect_closed(const Body& body) {
  const SurfaceSums sums = surface_sums(body);
  EXPECT_LT(sums.area.norm(), 1e-6 * sums.size);
  EXPECT_NEAR(sums.volume, body.volume_at_rest(), 1e-6 * body.volume_at_rest());
}

TEST(TissueSurface, VolumeOfASphereConvergesWithTheLattice) {
  constexpr double kRadius = 0.03;
  const double exact = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
  double before = 1;
  for (const double size : {0.016, 0.008, 0.004}) {
    const Body body = made(ball(kRadius, size));
    const double error = std::abs(body.volume_at_rest() - exact) / exact;
    EXPECT_LT(error, 0.5 * before) << size;
    before = error;
    expect_closed(body);
  }
  EXPECT_LT(before, 0.01);
}

TEST(TissueSurface, IsClosedForLatticesAndForTetrahedra) {
  expect_closed(made(block(Eigen::Vector3d(0.05, 0.04, 0.03), {3, 4, 2})));
  ObjectDescription bent = ball(0.03, 0.006);  // not convex
  for (Eigen::Vector3d& p : bent.surface.vertices) {
    p.z() += 12.0 * p.x() * p.x();
    p.y() *= 0.6;
  }
  expect_closed(made(bent));
}

TEST(TissueSurface, EveryEdgeHasTwoTrianglesThatUseItBothWays) {
  for (const ObjectDescription& d : {ball(0.03, 0.008), block(Eigen::Vector3d(0.05, 0.04, 0.03), {3, 4, 2})}) {
    const Body body = made(d);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& t : body.surface_triangles()) {
      for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    }
    for (const auto& [edge, count] : uses) {
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(uses.contains({edge.second, edge.first}));
    }
  }
}

TEST(TissueSurface, FillsWhatPicturesShow) {
  ObjectDescription d = ball(0.03, 0.008);
  for (const Eigen::Vector3d& p : d.surface.vertices) {
    d.surface.texture.emplace_back(static_cast<float>(p.x() / 0.03), static_cast<float>(p.y() / 0.03));
  }
  d.regions.push_back({.name = "dark",
                       .a = {0, 0, 0.03},
                       .b = {0, 0, 0.03},
                       .radius_m = 0.01,
                       .material = {},
                       .rgb = {0, 0, 0},
                       .has_colour = true});
  const Body body = made(d);
  TissueSurface surface;
  body.fill(surface);
  ASSERT_EQ(surface.vertices.size(), surface.topology->texture.size());
  ASSERT_EQ(surface.vertices.size(), surface.topology->rgb.size());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const Eigen::Vector3f& p = surface.vertices[i];
    EXPECT_GT(surface.normals[i].dot(p.normalized()), 0.5F);
    EXPECT_NEAR(surface.topology->texture[i].x(), p.x() / 0.03F, 0.1F);
    if ((p - Eigen::Vector3f(0, 0, 0.03F)).norm() < 0.005F) {
      EXPECT_EQ(surface.topology->rgb[i][0], 0.0F);
    }
    if (p.z() < 0) {
      EXPECT_EQ(surface.topology->rgb[i][0], d.rgba[0]);
    }
  }
  TissueNetwork network;
  body.network(network);
  EXPECT_EQ(network.nodes.size(), body.positions().size());
  EXPECT_EQ(network.kinds.size(), network.nodes.size());
  EXPECT_FALSE(network.links.empty());
  ASSERT_EQ(network.central_nodes.size(), 1U);
  EXPECT_TRUE(network.central_nodes[0].linear().isIdentity(1e-6));
}

}  // namespace
}  // namespace cellmirror::tissue
