#include <gtest/gtest.h>

#include <cmath>

#include "rt_core/geometry/proximity.hpp"
#include "shapes.hpp"

namespace cellmirror::geometry {
namespace {

using Eigen::Vector3d;
using test::at;
using test::random_pose;
using test::share;

constexpr std::size_t kMost = 8;

Contact contact_of(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB) {
  Contact out;
  EXPECT_TRUE(contact(a, X_WA, b, X_WB, kMost, out));
  return out;
}

void expect_sound(const Contact& sut) {
  EXPECT_GE(sut.points.size(), 1U);
  EXPECT_LE(sut.points.size(), kMost);
  EXPECT_EQ(sut.points.front().depth, sut.deepest.depth);
  for (const ContactPoint& point : sut.points) {
    EXPECT_TRUE(std::isfinite(point.depth));
    EXPECT_GE(point.depth, 0);
    EXPECT_LE(point.depth, sut.deepest.depth);
    EXPECT_NEAR(point.normal.norm(), 1, 1e-9);
    EXPECT_TRUE(point.p_W.allFinite());
  }
}

TEST(Contact, OfBodiesThatAreApartIsNone) {
  Contact out;
  const Solid box = make_mesh_solid(share(test::box_mesh({1, 1, 1})));
  const Solid ball = make_primitive(Shape::sphere, {0.5, 0, 0});
  EXPECT_FALSE(contact(box, at(0, 0, 0), box, at(1.1, 0, 0), kMost, out));
  EXPECT_FALSE(contact(box, at(0, 0, 0), ball, at(1.1, 0, 0), kMost, out));
  EXPECT_TRUE(out.points.empty());
}

TEST(Contact, OfTwoConvexMeshesIsTheShortestWayThatPartsThem) {
  const Solid box = make_mesh_solid(share(test::box_mesh({1, 1, 1})));
  const Contact sut = contact_of(box, at(0, 0, 0), box, at(0.9, 0.2, 0.1));
  expect_sound(sut);
  EXPECT_NEAR(sut.deepest.depth, 0.1, 1e-12);
  EXPECT_LT((sut.deepest.normal - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_NEAR(sut.deepest.p_W.x(), 0.45, 1e-9);
  EXPECT_GT(sut.points.size(), 3U);
}

TEST(Contact, IsThatOfThePrimitivesWhereMeshesAreConvex) {
  std::mt19937_64 random(21);
  const Solid box = make_primitive(Shape::box, {0.4, 0.2, 0.3});
  const Solid box_mesh = make_mesh_solid(share(test::box_mesh({0.4, 0.2, 0.3})));
  const Solid other_mesh = make_mesh_solid(share(test::box_mesh({0.1, 0.5, 0.2})));
  const std::vector<Solid> primitives = {
      make_primitive(Shape::box, {0.1, 0.5, 0.2}), make_primitive(Shape::sphere, {0.15, 0, 0}),
      make_primitive(Shape::capsule, {0.1, 0.3, 0}), make_primitive(Shape::cylinder, {0.1, 0.3, 0})};
  int touching = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose X_WA = random_pose(random, 0.2);
    const Pose X_WB = random_pose(random, 0.2);
    for (const Solid& primitive : primitives) {
      Contact expected;
      Contact sut;
      const bool touch = contact(box, X_WA, primitive, X_WB, kMost, expected);
      ASSERT_EQ(contact(box_mesh, X_WA, primitive, X_WB, kMost, sut), touch);
      if (!touch) continue;
      ++touching;
      expect_sound(sut);
      const double tolerance = primitive.shape == Shape::cylinder ? 0.001 * 0.1 : 1e-7;
      EXPECT_NEAR(sut.deepest.depth, expected.deepest.depth, tolerance);
      if (primitive.shape != Shape::box) continue;
      EXPECT_TRUE(contact(box_mesh, X_WA, other_mesh, X_WB, kMost, sut));
      EXPECT_NEAR(sut.deepest.depth, expected.deepest.depth, 1e-7);
    }
  }
  EXPECT_GT(touching, 200);
}

TEST(Contact, MovingByDepthAlongTheNormalPartsConvexBodies) {
  std::mt19937_64 random(22);
  TriangleMesh ball_mesh = test::icosphere(0.2, 2);
  ball_mesh.convex = true;
  const Solid ball = make_mesh_solid(share(ball_mesh));
  const Solid box = make_mesh_solid(share(test::box_mesh({0.4, 0.2, 0.3})));
  for (int i = 0; i < 100; ++i) {
    const Pose X_WA = random_pose(random, 0.15);
    Pose X_WB = random_pose(random, 0.15);
    Contact sut;
    if (!contact(ball, X_WA, box, X_WB, kMost, sut)) continue;
    const Vector3d way = sut.deepest.depth * sut.deepest.normal;
    ProximityHint hint;
    X_WB.translation() += way + 1e-6 * sut.deepest.normal;
    EXPECT_FALSE(touch(ball, X_WA, box, X_WB, hint));
    X_WB.translation() -= 0.01 * way + 2e-6 * sut.deepest.normal;
    EXPECT_TRUE(touch(ball, X_WA, box, X_WB, hint));
  }
}

TEST(Contact, TurnsItsNormalWithTheOrderOfTheBodies) {
  std::mt19937_64 random(23);
  const std::vector<Solid> solids = {
      make_mesh_solid(share(test::torus(0.3, 0.1, 16, 10))), make_mesh_solid(share(test::box_mesh({0.2, 0.3, 0.4}))),
      make_primitive(Shape::box, {0.2, 0.1, 0.4}), make_primitive(Shape::capsule, {0.1, 0.4, 0})};
  for (const Solid& a : solids) {
    for (const Solid& b : solids) {
      for (int i = 0; i < 20; ++i) {
        const Pose X_WA = random_pose(random, 0.2);
        const Pose X_WB = random_pose(random, 0.2);
        Contact one;
        Contact other;
        const bool touch = contact(a, X_WA, b, X_WB, kMost, one);
        ASSERT_EQ(contact(b, X_WB, a, X_WA, kMost, other), touch);
        if (!touch) continue;
        expect_sound(one);
        EXPECT_EQ(one.deepest.depth, other.deepest.depth);
        EXPECT_EQ(one.deepest.p_W, other.deepest.p_W);
      }
    }
  }
}

TEST(Contact, OfASphereInTheTubeOfATorusIsTheDepthOfItsSurface) {
  const Solid ring = make_mesh_solid(share(test::torus(1, 0.3, 96, 48)));
  const Solid ball = make_primitive(Shape::sphere, {0.1, 0, 0});
  const Contact poking = contact_of(ring, at(0, 0, 0), ball, at(1.35, 0, 0));  // 0.05 deep
  expect_sound(poking);
  EXPECT_NEAR(poking.deepest.depth, 0.05, 0.002);
  EXPECT_GT(poking.deepest.normal.x(), 0.99);
  const Contact within = contact_of(ring, at(0, 0, 0), ball, at(1.1, 0, 0));  // 0.2 to the surface, and the radius
  EXPECT_NEAR(within.deepest.depth, 0.3, 0.002);
  EXPECT_GT(within.deepest.normal.x(), 0.99);
}

TEST(Contact, OfACornerInAMeshThatIsNotConvexIsItsDepth) {
  const Solid two =
      make_mesh_solid(share(test::joined(test::box_mesh({1, 1, 1}), test::box_mesh({0.5, 0.5, 0.5}, {5, 0, 0}))));
  const Solid box = make_primitive(Shape::box, {0.2, 0.2, 0.2});
  const Solid box_mesh = make_mesh_solid(share(test::box_mesh({0.2, 0.2, 0.2})));
  for (const Solid* other : {&box, &box_mesh}) {
    const Contact sut = contact_of(two, at(0, 0, 0), *other, at(0.57, 0.1, 0.05));
    expect_sound(sut);
    EXPECT_NEAR(sut.deepest.depth, 0.03, 1e-9);
    EXPECT_LT((sut.deepest.normal - Vector3d::UnitX()).norm(), 1e-6);
  }
}

TEST(Contact, OfCrossingBarsIsDeepAlthoughNoCornerIsInside) {
  const TriangleMesh far = test::box_mesh({0.1, 0.1, 0.1}, {50, 0, 0});  // so that neither is convex
  const Solid along_x = make_mesh_solid(share(test::joined(test::box_mesh({2, 0.2, 0.2}), far)));
  const Solid along_y = make_mesh_solid(share(test::joined(test::box_mesh({0.2, 2, 0.2}), far)));
  const Contact sut = contact_of(along_x, at(0, 0, 0), along_y, at(0, 0, 0.15));  // 0.05 into each other
  expect_sound(sut);
  EXPECT_NEAR(sut.deepest.depth, 0.05, 1e-9);
  EXPECT_LT((sut.deepest.normal - Vector3d::UnitZ()).norm(), 1e-6);
}

TEST(Contact, OfANestedBodyIsItsDepthBelowTheSurface) {
  const Solid shell = make_mesh_solid(share(test::torus(1, 0.4, 64, 32)));
  const Solid small = make_mesh_solid(share(test::torus(0.05, 0.02, 12, 8)));
  const Contact sut = contact_of(shell, at(0, 0, 0), small, at(1, 0, 0));
  expect_sound(sut);
  EXPECT_NEAR(sut.deepest.depth, 0.4, 0.03);
}

TEST(Contact, OfOpenSurfacesHasPointsOnBothAndNoDepth) {
  const Solid sheet = make_mesh_solid(share(test::sheet(1, 5)));
  Pose upright = at(0.1, 0.05, 0.1);
  upright.linear() = Eigen::AngleAxisd(1.2, Vector3d::UnitX()).toRotationMatrix();
  const Contact sut = contact_of(sheet, at(0, 0, 0), sheet, upright);
  expect_sound(sut);
  EXPECT_EQ(sut.deepest.depth, 0);
  EXPECT_GT(sut.points.size(), 2U);
  for (const ContactPoint& point : sut.points) EXPECT_NEAR(point.p_W.z(), 0, 1e-12);
}

TEST(Contact, OfASheetInAPrimitiveIsAsDeepAsItsInnermostPoint) {
  const Solid sheet = make_mesh_solid(share(test::sheet(4, 1)));
  const Solid box = make_primitive(Shape::box, {0.2, 0.3, 0.4});
  const Solid ball = make_primitive(Shape::sphere, {0.2, 0, 0});
  const Contact in_box = contact_of(sheet, at(0, 0, 0), box, at(0.3, 0.1, 0.15));
  expect_sound(in_box);
  EXPECT_NEAR(in_box.deepest.depth, 0.05, 1e-9);
  const Contact in_ball = contact_of(sheet, at(0, 0, 0), ball, at(0.3, 0.1, 0.15));
  EXPECT_NEAR(in_ball.deepest.depth, 0.05, 1e-9);
  EXPECT_LT((in_ball.deepest.normal - Vector3d::UnitZ()).norm(), 1e-6);
}

TEST(Contact, StaysFiniteForDegeneratePoses) {
  const Solid box = make_mesh_solid(share(test::box_mesh({1, 1, 1})));
  const Solid ring = make_mesh_solid(share(test::torus(0.3, 0.1, 16, 8)));
  const Solid ball = make_primitive(Shape::sphere, {0.5, 0, 0});
  expect_sound(contact_of(box, at(0, 0, 0), box, at(0, 0, 0)));
  expect_sound(contact_of(box, at(0, 0, 0), box, at(1, 0, 0)));
  expect_sound(contact_of(ring, at(0, 0, 0), ring, at(0, 0, 0)));
  expect_sound(contact_of(ball, at(0, 0, 0), ball, at(0, 0, 0)));
  expect_sound(contact_of(ball, at(0, 0, 0), box, at(0, 0, 0)));
  EXPECT_NEAR(contact_of(box, at(0, 0, 0), box, at(1, 0, 0)).deepest.depth, 0, 1e-9);
  Contact out;
  EXPECT_TRUE(contact(box, at(std::nan(""), 0, 0), box, at(0, 0, 0), kMost, out));
  EXPECT_EQ(out.deepest.depth, 0);
}

}  // namespace
}  // namespace cellmirror::geometry
