// Hulls and convex decompositions.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>

#include "rt_core/geometry/convex/convex_hull.hpp"
#include "rt_core/geometry/convex/convex_parts.hpp"
#include "tests/unit/geometry_mesh/shapes.hpp"

namespace cellmirror::geometry {
namespace {

// How far p stands out of a convex mesh, m; negative inside. Needles have no normal to speak of.
double outside(const TriangleMesh& convex, const Eigen::Vector3d& p) {
  double most = -std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : convex.triangles) {
    const Eigen::Vector3d& o = convex.vertices[a];
    const Eigen::Vector3d u = convex.vertices[b] - o;
    const Eigen::Vector3d v = convex.vertices[c] - o;
    const Eigen::Vector3d normal = u.cross(v);
    if (normal.norm() < 1e-6 * std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()})) continue;
    most = std::max(most, normal.normalized().dot(p - o));
  }
  return most;
}

double outside_all(const std::vector<TriangleMesh>& pieces, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const TriangleMesh& piece : pieces) least = std::min(least, outside(piece, p));
  return least;
}

TriangleMesh repaired(const Soup& soup) {
  MeshFindings findings;
  return make_mesh("m", soup.vertices, soup.triangles, findings).value();
}

void expect_convex(const TriangleMesh& mesh) {
  EXPECT_TRUE(mesh.closed);
  EXPECT_TRUE(mesh.convex);
  EXPECT_GT(signed_volume(mesh), 0.0);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : mesh.vertices) box.extend(p);
  for (const Eigen::Vector3d& p : mesh.vertices) EXPECT_LE(outside(mesh, p), 1e-9 * box.diagonal().norm());
}

TEST(ConvexHull, of_random_points_contains_them_all_at_every_scale) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3}) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 500; ++i)
      points.emplace_back(scale * Eigen::Vector3d(normal(random) + 3.0, normal(random), 0.01 * normal(random)));
    const auto sut = convex_hull("h", points);
    ASSERT_TRUE(sut) << scale;
    expect_convex(*sut);
    for (const Eigen::Vector3d& p : points) EXPECT_LE(outside(*sut, p), 1e-9 * scale);
  }
}

TEST(ConvexHull, of_a_cube_with_points_in_its_faces_and_copies_is_the_cube) {
  std::vector<Eigen::Vector3d> points = cube().vertices;
  for (double x = -0.5; x <= 0.5; x += 0.125) {
    for (double y = -0.5; y <= 0.5; y += 0.125) {
      points.emplace_back(x, y, 0.5);
      points.emplace_back(x, -0.5, y);
      points.emplace_back(0.5, x, y);
      points.emplace_back(0.5, x, y);
    }
  }
  const auto sut = convex_hull("h", points);
  ASSERT_TRUE(sut);
  expect_convex(*sut);
  EXPECT_NEAR(signed_volume(*sut), 1.0, 1e-9);
}

TEST(ConvexHull, of_a_fine_round_body) {
  const Soup ring = torus(1.0, 0.4, 60, 30);
  const auto sut = convex_hull("h", ring.vertices);
  ASSERT_TRUE(sut);
  expect_convex(*sut);
  for (const Eigen::Vector3d& p : ring.vertices) EXPECT_LE(outside(*sut, p), 1e-9);
}

TEST(ConvexHull, refuses_what_has_no_volume) {
  const auto refused = [](const std::vector<Eigen::Vector3d>& points) { return !convex_hull("h", points).has_value(); };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.2, 0}}));
  EXPECT_TRUE(refused({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}));
  EXPECT_TRUE(refused(std::vector<Eigen::Vector3d>(10, {1, 2, 3})));
  EXPECT_TRUE(refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::numeric_limits<double>::quiet_NaN()}}));
  const auto flat = convex_hull("sheet.stl", cube().scaled(0.0).vertices);
  ASSERT_FALSE(flat);
  EXPECT_EQ(flat.error().what, "sheet.stl is flat and has no convex hull");
}

// Corners and random points of the surface, and of the inside by segments between surface points that stay inside.
void expect_contains(const std::vector<TriangleMesh>& pieces, const TriangleMesh& mesh) {
  for (const Eigen::Vector3d& p : mesh.vertices) EXPECT_LE(outside_all(pieces, p), 1e-9);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const auto& [a, b, c] : mesh.triangles) {
    for (int i = 0; i < 4; ++i) {
      double u = share(random);
      double v = share(random);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Eigen::Vector3d p =
          mesh.vertices[a] + u * (mesh.vertices[b] - mesh.vertices[a]) + v * (mesh.vertices[c] - mesh.vertices[a]);
      EXPECT_LE(outside_all(pieces, p), 1e-9);
    }
  }
}

double total_volume(const std::vector<TriangleMesh>& pieces) {
  double volume = 0.0;
  for (const TriangleMesh& piece : pieces) volume += signed_volume(piece);
  return volume;
}

TEST(ConvexParts, a_convex_body_is_one_part) {
  const auto sut = convex_parts(repaired(cube()));
  ASSERT_TRUE(sut);
  ASSERT_EQ(sut->size(), 1U);
  EXPECT_NEAR(signed_volume(sut->front()), 1.0, 1e-12);
  EXPECT_EQ(sut->front().name, "m part 1");
}

TEST(ConvexParts, a_ring_has_its_hole_again) {
  const TriangleMesh ring = repaired(torus(1.0, 0.25, 48, 16));
  const auto sut = convex_parts(ring);
  ASSERT_TRUE(sut);
  EXPECT_GT(sut->size(), 4U);
  EXPECT_LE(sut->size(), 24U);
  for (const TriangleMesh& piece : *sut) expect_convex(piece);
  expect_contains(*sut, ring);
  EXPECT_GT(outside_all(*sut, Eigen::Vector3d::Zero()), 0.4);
  const double volume = signed_volume(ring);
  EXPECT_GE(total_volume(*sut), volume);
  EXPECT_LE(total_volume(*sut), 1.3 * volume);
}

TEST(ConvexParts, keep_to_the_count_and_contain_the_mesh_all_the_same) {
  const TriangleMesh ring = repaired(torus(1.0, 0.25, 32, 12));
  for (const std::size_t most : {0U, 1U, 2U, 5U}) {
    const auto sut = convex_parts(ring, {0.001, most});
    ASSERT_TRUE(sut);
    EXPECT_LE(sut->size(), std::max<std::size_t>(most, 1));
    expect_contains(*sut, ring);
  }
}

TEST(ConvexParts, contain_bodies_of_boxes_with_all_that_is_inside) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::uniform_real_distribution<double> share(-0.5, 0.5);
  for (int round = 0; round < 5; ++round) {
    Soup soup;
    std::vector<Eigen::Vector3d> centres;
    for (int i = 0; i < 4; ++i) {
      centres.emplace_back(place(random), place(random), place(random));
      soup.add(cube().scaled(0.4).moved(centres.back()));
    }
    const TriangleMesh mesh = repaired(soup);
    const auto sut = convex_parts(mesh);
    ASSERT_TRUE(sut);
    expect_contains(*sut, mesh);
    for (const TriangleMesh& piece : *sut) expect_convex(piece);
    for (const Eigen::Vector3d& centre : centres) {
      for (int i = 0; i < 100; ++i) {
        const Eigen::Vector3d p = centre + 0.4 * Eigen::Vector3d(share(random), share(random), share(random));
        EXPECT_LE(outside_all(*sut, p), 1e-9);
      }
    }
  }
}

TEST(ConvexParts, an_open_mesh_is_contained_too) {
  Soup soup = torus(1.0, 0.25, 24, 12);
  soup.triangles.resize(soup.triangles.size() / 2);
  const TriangleMesh mesh = repaired(soup);
  EXPECT_FALSE(mesh.closed);
  const auto sut = convex_parts(mesh);
  ASSERT_TRUE(sut);
  expect_contains(*sut, mesh);
}

TEST(ConvexParts, refuse_a_flat_mesh) {
  const auto sut = convex_parts(repaired({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}}));
  EXPECT_FALSE(sut);
}

}  // namespace
}  // namespace cellmirror::geometry
