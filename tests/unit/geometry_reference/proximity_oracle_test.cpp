// Distance and touch of solids against the slow oracle: every kind of mesh with every other and with primitives.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "rt_core/geometry/proximity.hpp"
#include "tests/support/geometry_oracle/brute_force.hpp"
#include "tests/support/geometry_oracle/meshes.hpp"

namespace cellmirror::geometry {
namespace {

using Eigen::Vector3d;
using geometry_oracle::any_pose;
using geometry_oracle::box_mesh;
using geometry_oracle::Corners;
using geometry_oracle::globe_mesh;
using geometry_oracle::Point;
using geometry_oracle::prism_mesh;
using geometry_oracle::Real;
using geometry_oracle::shared;
using geometry_oracle::sheet_mesh;
using geometry_oracle::soup_mesh;

constexpr double kExact = 1e-9;  // m
constexpr double kFar = std::numeric_limits<double>::infinity();

// What a query answered, checked against `expected` (m): distance, points, symmetry, bound, hint.
void expect_separation(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB, double expected,
                       double tolerance = kExact) {
  ProximityHint hint;
  const Separation found = separation(a, X_WA, b, X_WB, kFar, hint);
  ASSERT_TRUE(found.certain);
  ASSERT_FALSE(found.beyond);
  ASSERT_NEAR(found.points.distance, expected, tolerance);
  ASSERT_NEAR((found.points.p_a - found.points.p_b).norm(), found.points.distance, tolerance);
  const Separation again = separation(a, X_WA, b, X_WB, kFar, hint);
  ASSERT_NEAR(again.points.distance, expected, tolerance);
  ProximityHint nonsense{4'000'000'000U, 77U, true};
  ASSERT_NEAR(separation(b, X_WB, a, X_WA, kFar, nonsense).points.distance, expected, tolerance);
  for (const double up_to : {0.5 * expected, 2.0 * expected + 1e-3}) {
    ProximityHint fresh;
    const Separation bounded = separation(a, X_WA, b, X_WB, up_to, fresh);
    if (expected < up_to) {
      ASSERT_NEAR(bounded.points.distance, expected, tolerance);
    } else if (expected > kTouchDistance + tolerance) {
      ASSERT_TRUE(bounded.beyond || std::abs(bounded.points.distance - expected) <= tolerance);
      ASSERT_LE(bounded.points.distance, expected + tolerance);
    }
  }
  if (std::abs(expected - kTouchDistance) <= tolerance && expected > 0.0) return;
  ProximityHint fresh;
  ASSERT_EQ(touch(a, X_WA, b, X_WB, fresh), expected <= kTouchDistance);
  ASSERT_EQ(touch(b, X_WB, a, X_WA, hint), expected <= kTouchDistance);
}

std::vector<std::shared_ptr<const TriangleMesh>> all_meshes() {
  std::mt19937_64 random(21);
  return {shared(box_mesh({0.3, 0.2, 0.1})),        shared(prism_mesh(0.2, 0.3, 17)),
          shared(globe_mesh(0.3, 10, 16)),          shared(globe_mesh(0.3, 14, 18, 0.3)),
          shared(sheet_mesh(0.4, 12, 0.1)),         shared(sheet_mesh(0.3, 5, 0.0)),
          shared(soup_mesh(random, 60, 0.3, 0.15)), shared(soup_mesh(random, 1, 0.1, 0.3))};
}

TEST(Oracle, goesOnceAroundWhatIsClosed) {
  for (const auto& mesh : all_meshes()) {
    if (!mesh->closed) continue;
    const auto surface = geometry_oracle::placed(*mesh, Pose::Identity());
    EXPECT_NEAR(static_cast<double>(geometry_oracle::winding_number(surface, {0, 0, 0.01L})), 1.0, 1e-9) << mesh->name;
    EXPECT_NEAR(static_cast<double>(geometry_oracle::winding_number(surface, {5, 5, 5})), 0.0, 1e-9) << mesh->name;
  }
}

TEST(Separation, ofMeshesAgreesWithTheOracle) {
  std::mt19937_64 random(22);
  const auto meshes = all_meshes();
  for (const auto& mesh_a : meshes) {
    const Solid a = make_mesh_solid(mesh_a);
    for (const auto& mesh_b : meshes) {
      const Solid b = make_mesh_solid(mesh_b);
      for (int i = 0; i < 3 && !::testing::Test::HasFatalFailure(); ++i) {
        const Pose X_WA = any_pose(random, 0.2 + 0.15 * i);
        const Pose X_WB = any_pose(random, 0.2 + 0.15 * i);
        expect_separation(a, X_WA, b, X_WB, geometry_oracle::distance(*mesh_a, X_WA, *mesh_b, X_WB));
      }
    }
  }
}

TEST(Separation, seesBodiesWithinBodies) {
  const auto outer = shared(globe_mesh(0.5, 12, 16, 0.1));
  const auto inner = shared(globe_mesh(0.1, 6, 8));
  const auto sheet = shared(sheet_mesh(0.1, 4, 0.02));
  const auto open = shared(sheet_mesh(0.6, 6, 0.0));
  std::mt19937_64 random(23);
  const Pose X = any_pose(random, 1.0);
  const Solid large = make_mesh_solid(outer);
  for (const Solid& small :
       {make_mesh_solid(inner), make_mesh_solid(sheet), make_primitive(Shape::sphere, {0.05, 0, 0}),
        make_primitive(Shape::box, {0.1, 0.2, 0.1}), make_primitive(Shape::cylinder, {0.1, 0.1, 0}),
        make_primitive(Shape::capsule, {0.05, 0.2, 0})}) {
    expect_separation(large, X, small, X, 0.0);
    // An open surface has no inside: what is beside it is beside it.
    ProximityHint hint;
    EXPECT_GT(
        separation(make_mesh_solid(open), X, small, X * Eigen::Translation3d(0, 0, 0.4), kFar, hint).points.distance,
        0.1);
  }
  // A mesh within a primitive.
  for (const Solid& around :
       {make_primitive(Shape::sphere, {0.4, 0, 0}), make_primitive(Shape::box, {0.8, 0.8, 0.8}),
        make_primitive(Shape::cylinder, {0.4, 0.8, 0}), make_primitive(Shape::capsule, {0.4, 0.1, 0})}) {
    expect_separation(make_mesh_solid(inner), X, around, X, 0.0);
    expect_separation(make_mesh_solid(sheet), X, around, X, 0.0);
  }
}

TEST(Separation, ofIdenticalAndTouchingMeshesIsZero) {
  std::mt19937_64 random(24);
  for (const auto& mesh : all_meshes()) {
    const Solid sut = make_mesh_solid(mesh);
    const Pose X = any_pose(random, 1.0);
    ProximityHint hint;
    EXPECT_LT(separation(sut, X, sut, X, kFar, hint).points.distance, kTouchDistance);
    EXPECT_TRUE(touch(sut, X, sut, X, hint));
  }
  // Faces that are flush, over an area, an edge and a corner.
  const Solid cube = make_mesh_solid(shared(box_mesh({0.5, 0.5, 0.5})));
  for (const Vector3d& offset : {Vector3d(1, 0, 0), Vector3d(1, 0.3, -0.2), Vector3d(1, 1, 0), Vector3d(1, 1, 1)}) {
    Pose X = Pose::Identity();
    X.translation() = offset;
    ProximityHint hint;
    EXPECT_TRUE(touch(cube, Pose::Identity(), cube, X, hint)) << offset.transpose();
    X.translation() *= 1.0 + 1e-6;
    EXPECT_FALSE(touch(cube, Pose::Identity(), cube, X, hint)) << offset.transpose();
  }
}

// Distance of a segment (or point) from all triangles, less the thickness around it.
Real from_segment(const std::vector<Corners>& triangles, const Point& from, const Point& to, Real thickness) {
  const auto found = geometry_oracle::surface_distance({{from, to, to}}, triangles);
  return std::max(Real{0}, found.distance - thickness);
}

TEST(Separation, ofMeshesAndPrimitivesAgreesWithTheOracle) {
  std::mt19937_64 random(25);
  const Solid sphere = make_primitive(Shape::sphere, {0.1, 0, 0});
  const Solid capsule = make_primitive(Shape::capsule, {0.1, 0.4, 0});
  const Solid box = make_primitive(Shape::box, {0.2, 0.3, 0.4});
  const Solid cylinder = make_primitive(Shape::cylinder, {0.15, 0.4, 0});
  const TriangleMesh box_surface = box_mesh({0.1, 0.15, 0.2});
  constexpr std::uint32_t kSides = 48;
  const TriangleMesh within = prism_mesh(0.15, 0.2, kSides);
  const TriangleMesh around = prism_mesh(0.15 / std::cos(std::numbers::pi / kSides), 0.2, kSides);
  for (const auto& mesh : all_meshes()) {
    const Solid sut = make_mesh_solid(mesh);
    for (int i = 0; i < 6 && !::testing::Test::HasFatalFailure(); ++i) {
      const Pose X_WM = any_pose(random, 0.1 + 0.1 * i);
      const Pose X_WP = any_pose(random, 0.1 + 0.1 * i);
      const auto triangles = geometry_oracle::placed(*mesh, X_WP.inverse() * X_WM);
      const bool inside = mesh->closed && geometry_oracle::winding_number(triangles, {0, 0, 0}) > 0.5L;
      const auto expected = [&](Real value) { return inside ? 0.0 : static_cast<double>(value); };
      expect_separation(sut, X_WM, sphere, X_WP, expected(from_segment(triangles, {0, 0, 0}, {0, 0, 0}, 0.1L)));
      expect_separation(sut, X_WM, capsule, X_WP, expected(from_segment(triangles, {0, 0, -0.2L}, {0, 0, 0.2L}, 0.1L)));
      expect_separation(sut, X_WM, box, X_WP, geometry_oracle::distance(*mesh, X_WM, box_surface, X_WP));
      // A cylinder lies between two prisms.
      ProximityHint hint;
      const double found = separation(sut, X_WM, cylinder, X_WP, kFar, hint).points.distance;
      ASSERT_LE(found, geometry_oracle::distance(*mesh, X_WM, within, X_WP) + kExact);
      ASSERT_GE(found, geometry_oracle::distance(*mesh, X_WM, around, X_WP) - kExact);
    }
  }
}

TEST(Separation, holdsAtAnySizeAndFarFromTheOrigin) {
  std::mt19937_64 random(26);
  for (const double scale : {1e-4, 1.0, 1e3}) {
    const auto grown = [&](TriangleMesh mesh) {
      for (Vector3d& vertex : mesh.vertices) vertex *= scale;
      return shared(std::move(mesh));
    };
    const auto mesh_a = grown(globe_mesh(0.3, 8, 10, 0.3));
    const auto mesh_b = grown(sheet_mesh(0.4, 6, 0.1));
    const Solid a = make_mesh_solid(mesh_a);
    const Solid b = make_mesh_solid(mesh_b);
    for (int i = 0; i < 10; ++i) {
      Pose X_WA = any_pose(random, 0.4 * scale);
      Pose X_WB = any_pose(random, 0.4 * scale);
      X_WA.translation() += Vector3d(1e5, -1e5, 2e5);
      X_WB.translation() += Vector3d(1e5, -1e5, 2e5);
      const double expected = geometry_oracle::distance(*mesh_a, X_WA, *mesh_b, X_WB);
      ProximityHint hint;
      EXPECT_NEAR(separation(a, X_WA, b, X_WB, kFar, hint).points.distance, expected, 1e-9 + 1e-12 * scale);
    }
  }
}

// A hint from any earlier posture helps and never harms.
TEST(Separation, followsMotionByItsHint) {
  const auto mesh_a = shared(globe_mesh(0.3, 10, 14, 0.3));
  const auto mesh_b = shared(prism_mesh(0.1, 0.4, 12));
  const Solid a = make_mesh_solid(mesh_a);
  const Solid b = make_mesh_solid(mesh_b);
  ProximityHint hint;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.15 * i;
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(t, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    X.translation() = Vector3d(0.6 * std::cos(0.7 * t), 0.5 * std::sin(0.4 * t), 0.3 * std::sin(t));
    const double expected = geometry_oracle::distance(*mesh_a, Pose::Identity(), *mesh_b, X);
    EXPECT_NEAR(separation(a, Pose::Identity(), b, X, kFar, hint).points.distance, expected, kExact) << i;
  }
}

}  // namespace
}  // namespace cellmirror::geometry
