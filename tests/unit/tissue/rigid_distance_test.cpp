// Signed distances of points from rigid bodies: closed forms, and meshes of the same shape.
#include "rt_core/tissue/contact/rigid_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror::tissue {
namespace {

using Eigen::Vector3d;

TEST(RigidDistance, is_signed_and_points_outwards) {
  geometry::ProximityHint hint;
  const geometry::Solid box = geometry::make_primitive(Shape::box, {0.2, 0.4, 0.6});
  RigidDistance d = rigid_distance(box, {0.13, 0, 0.05}, 1, hint);
  EXPECT_NEAR(d.distance, 0.03, 1e-12);
  EXPECT_NEAR((d.normal - Vector3d::UnitX()).norm(), 0, 1e-12);
  d = rigid_distance(box, {0, -0.19, 0}, 1, hint);
  EXPECT_NEAR(d.distance, -0.01, 1e-12);
  EXPECT_NEAR((d.normal + Vector3d::UnitY()).norm(), 0, 1e-12);
  EXPECT_NEAR(d.nearest.y(), -0.2, 1e-12);
  d = rigid_distance(box, {0.13, 0.24, 0}, 1, hint);
  EXPECT_NEAR(d.distance, 0.05, 1e-12) << "to an edge";

  const geometry::Solid sphere = geometry::make_primitive(Shape::sphere, Vector3d::Constant(0.1));
  d = rigid_distance(sphere, {0, 0, 0.02}, 1, hint);
  EXPECT_NEAR(d.nearest.norm(), sphere.radius, 1e-9);
  EXPECT_NEAR(d.distance, 0.02 - sphere.radius, 1e-9);

  EXPECT_FALSE(rigid_distance(box, {1, 0, 0}, 0.1, hint).known) << "farther than asked for";
  EXPECT_FALSE(rigid_distance(box, {std::nan(""), 0, 0}, 0.1, hint).known);
}

TEST(RigidDistance, of_a_mesh_is_that_of_the_same_primitive) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  mesh->name = "box";
  for (unsigned i = 0; i < 8; ++i) {
    mesh->vertices.emplace_back((i & 1U) != 0 ? 0.1 : -0.1, (i & 2U) != 0 ? 0.2 : -0.2, (i & 4U) != 0 ? 0.3 : -0.3);
  }
  mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  mesh->closed = true;
  const geometry::Solid of_mesh = geometry::make_mesh_solid(mesh);
  const geometry::Solid primitive = geometry::make_primitive(Shape::box, {0.2, 0.4, 0.6});
  geometry::ProximityHint hint;
  geometry::ProximityHint other;
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> at(-0.4, 0.4);
  for (int i = 0; i < 500; ++i) {
    const Vector3d p(at(generator), at(generator), at(generator));
    const RigidDistance a = rigid_distance(of_mesh, p, 1, hint);
    const RigidDistance b = rigid_distance(primitive, p, 1, other);
    ASSERT_TRUE(a.known);
    ASSERT_NEAR(a.distance, b.distance, 1e-9) << p.transpose();
    ASSERT_NEAR((p - a.distance * a.normal - a.nearest).norm(), 0, 1e-9) << p.transpose();
  }
}

TEST(RigidDistance, of_a_cylinder_and_a_capsule) {
  geometry::ProximityHint hint;
  // Their sizes as geometry gives them to the core, whatever the order in `size` is.
  const geometry::Solid cylinder = geometry::make_primitive(Shape::cylinder, {0.1, 0.1, 0.4});
  const double radius = cylinder.core.half.x();
  const double half = cylinder.core.half.z();
  EXPECT_NEAR(rigid_distance(cylinder, {radius + 0.02, 0, 0}, 1, hint).distance, 0.02, 1e-12);
  EXPECT_NEAR(rigid_distance(cylinder, {0, 0, half + 0.03}, 1, hint).distance, 0.03, 1e-12);
  EXPECT_NEAR(rigid_distance(cylinder, {radius + 0.03, 0, half + 0.04}, 1, hint).distance, 0.05, 1e-12);
  EXPECT_NEAR(rigid_distance(cylinder, {radius - 0.001, 0, 0}, 1, hint).distance, -0.001, 1e-12);
  const geometry::Solid capsule = geometry::make_primitive(Shape::capsule, {0.1, 0.1, 0.4});
  const double end = capsule.core.half.z() + capsule.core.skin;
  EXPECT_NEAR(rigid_distance(capsule, {0, 0, end + 0.03}, 1, hint).distance, 0.03, 1e-12);
  EXPECT_NEAR(rigid_distance(capsule, {0, capsule.core.skin - 0.002, 0}, 1, hint).distance, -0.002, 1e-12);
}

}  // namespace
}  // namespace cellmirror::tissue
