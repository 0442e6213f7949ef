#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rt_core/geometry/proximity.hpp"
#include "shapes.hpp"

namespace cellmirror::geometry {
namespace {

using Eigen::Vector3d;
using test::at;
using test::random_pose;
using test::share;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vector3d kUnitBox{1, 1, 1};

Separation distance(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB) {
  ProximityHint hint;
  return separation(a, X_WA, b, X_WB, kInfinity, hint);
}

bool touching(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB) {
  ProximityHint hint;
  return touch(a, X_WA, b, X_WB, hint);
}

Triangle placed(const MeshTree& tree, std::size_t i, const Pose& X) {
  const Triangle& t = tree.triangles()[i];
  return {X * t[0], X * t[1], X * t[2]};
}

// Every triangle against every other, of the surfaces alone.
double by_all_pairs(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB) {
  double least = kInfinity;
  for (std::size_t i = 0; i < a.tree->triangles().size(); ++i) {
    const Triangle in_a = placed(*a.tree, i, X_WA);
    for (std::size_t k = 0; k < b.tree->triangles().size(); ++k) {
      least = std::min(least, triangle_triangle(in_a, placed(*b.tree, k, X_WB), least).distance);
    }
  }
  return least;
}

double by_all_triangles(const Solid& mesh, const Pose& X_WM, const Solid& primitive, const Pose& X_WP) {
  double least = kInfinity;
  for (std::size_t i = 0; i < mesh.tree->triangles().size(); ++i) {
    ConvexCore core;
    core.kind = CoreKind::triangle;
    core.corners = placed(*mesh.tree, i, X_WM);
    least = std::min(least, convex_distance(core, Pose::Identity(), primitive.core, X_WP).points.distance);
  }
  return least;
}

void expect_points_agree(const Separation& s) {
  EXPECT_NEAR((s.points.p_a - s.points.p_b).norm(), s.points.distance, 1e-12);
}

TEST(Separation, OfRandomSurfacesIsThatOfAllPairsOfTriangles) {
  std::mt19937_64 random(3);
  const Solid a = make_mesh_solid(share(test::soup(150, 0.15, 1)));
  const Solid b = make_mesh_solid(share(test::soup(120, 0.3, 2)));
  for (int i = 0; i < 60; ++i) {
    const Pose X_WA = random_pose(random, 0.7);
    const Pose X_WB = random_pose(random, 0.7);
    const Separation sut = distance(a, X_WA, b, X_WB);
    EXPECT_NEAR(sut.points.distance, by_all_pairs(a, X_WA, b, X_WB), 1e-12);
    expect_points_agree(sut);
    EXPECT_TRUE(sut.certain);
  }
}

TEST(Separation, OfClosedMeshesIsThatOfAllPairsWhereTheyAreApart) {
  std::mt19937_64 random(4);
  const Solid a = make_mesh_solid(share(test::torus(0.3, 0.1, 16, 8)));
  const Solid b = make_mesh_solid(share(test::icosphere(0.15, 2)));
  int apart = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose X_WA = random_pose(random, 0.3);
    const Pose X_WB = random_pose(random, 0.3);
    const double expected = by_all_pairs(a, X_WA, b, X_WB);
    const Separation sut = distance(a, X_WA, b, X_WB);
    if (expected > 0 && sut.points.distance > 0) ++apart;
    if (expected == 0 || sut.points.distance > 0) {
      EXPECT_NEAR(sut.points.distance, expected, 1e-12);
    }
    EXPECT_EQ(touching(a, X_WA, b, X_WB), sut.points.distance < kTouchDistance);
  }
  EXPECT_GT(apart, 10);
}

TEST(Separation, OfAMeshAndAPrimitiveIsThatOfAllTriangles) {
  std::mt19937_64 random(5);
  const Solid mesh = make_mesh_solid(share(test::soup(200, 0.2, 7)));
  for (const Shape shape : {Shape::box, Shape::sphere, Shape::capsule, Shape::cylinder}) {
    const Solid primitive = make_primitive(shape, {0.2, 0.3, 0.1});
    for (int i = 0; i < 30; ++i) {
      const Pose X_WM = random_pose(random, 0.6);
      const Pose X_WP = random_pose(random, 0.6);
      const Separation sut = distance(mesh, X_WM, primitive, X_WP);
      EXPECT_NEAR(sut.points.distance, by_all_triangles(mesh, X_WM, primitive, X_WP), 1e-9);
      if (sut.certain) {
        EXPECT_NEAR((sut.points.p_a - sut.points.p_b).norm(), sut.points.distance, 1e-8);
      }
    }
  }
}

TEST(Separation, OfBoxesAsMeshesIsThatOfTheBoxes) {
  std::mt19937_64 random(6);
  const Solid box = make_primitive(Shape::box, {0.4, 0.2, 0.3});
  const Solid mesh = make_mesh_solid(share(test::box_mesh({0.4, 0.2, 0.3})));
  const Solid other = make_primitive(Shape::box, {0.1, 0.5, 0.2});
  const Solid other_mesh = make_mesh_solid(share(test::box_mesh({0.1, 0.5, 0.2})));
  for (int i = 0; i < 300; ++i) {
    const Pose X_WA = random_pose(random, 0.4);
    const Pose X_WB = random_pose(random, 0.4);
    const double expected = distance(box, X_WA, other, X_WB).points.distance;
    EXPECT_NEAR(distance(mesh, X_WA, other_mesh, X_WB).points.distance, expected, 1e-9);
    EXPECT_NEAR(distance(mesh, X_WA, other, X_WB).points.distance, expected, 1e-9);
    EXPECT_NEAR(distance(box, X_WA, other_mesh, X_WB).points.distance, expected, 1e-9);
  }
}

TEST(Separation, SwappedArgumentsSwapThePoints) {
  std::mt19937_64 random(7);
  const std::vector<Solid> solids = {
      make_mesh_solid(share(test::torus(0.3, 0.1, 12, 8))), make_mesh_solid(share(test::box_mesh({0.2, 0.3, 0.4}))),
      make_primitive(Shape::box, {0.2, 0.1, 0.4}), make_primitive(Shape::capsule, {0.1, 0.4, 0})};
  for (const Solid& a : solids) {
    for (const Solid& b : solids) {
      for (int i = 0; i < 20; ++i) {
        const Pose X_WA = random_pose(random, 0.6);
        const Pose X_WB = random_pose(random, 0.6);
        const Separation one = distance(a, X_WA, b, X_WB);
        const Separation other = distance(b, X_WB, a, X_WA);
        EXPECT_EQ(one.points.distance, other.points.distance);
        EXPECT_EQ(one.points.p_a, other.points.p_b);
        EXPECT_EQ(one.points.p_b, other.points.p_a);
      }
    }
  }
}

TEST(Separation, IsTheSameWhateverTheHint) {
  std::mt19937_64 random(8);
  const Solid a = make_mesh_solid(share(test::torus(0.3, 0.1, 16, 8)));
  const Solid b = make_mesh_solid(share(test::icosphere(0.15, 2)));
  const Solid c = make_primitive(Shape::box, {0.1, 0.2, 0.3});
  for (int i = 0; i < 40; ++i) {
    const Pose X_WA = random_pose(random, 0.4);
    const Pose X_WB = random_pose(random, 0.4);
    const Separation mesh = distance(a, X_WA, b, X_WB);
    const Separation box = distance(a, X_WA, c, X_WB);
    for (const std::uint32_t value : {0U, 17U, 255U, 256U, 100000U, ~0U}) {
      ProximityHint hint{value, value / 2, true};
      EXPECT_NEAR(separation(a, X_WA, b, X_WB, kInfinity, hint).points.distance, mesh.points.distance, 1e-13);
      EXPECT_NEAR(separation(a, X_WA, b, X_WB, kInfinity, hint).points.distance, mesh.points.distance, 1e-13);
      hint = {value, value / 2, true};
      EXPECT_EQ(touch(a, X_WA, b, X_WB, hint), mesh.points.distance < kTouchDistance);
      hint = {value, value / 2, true};
      EXPECT_NEAR(separation(c, X_WB, a, X_WA, kInfinity, hint).points.distance, box.points.distance, 1e-9);
    }
  }
}

TEST(Separation, TellsALowerBoundWhereItIsBeyondTheLimit) {
  std::mt19937_64 random(9);
  const Solid a = make_mesh_solid(share(test::torus(0.3, 0.1, 16, 8)));
  const Solid b = make_mesh_solid(share(test::icosphere(0.1, 2)));
  const Solid c = make_primitive(Shape::cylinder, {0.1, 0.2, 0});
  for (int i = 0; i < 200; ++i) {
    const Pose X_WA = random_pose(random, 0.6);
    const Pose X_WB = random_pose(random, 0.6);
    for (const Solid* other : {&b, &c}) {
      const double exact = distance(a, X_WA, *other, X_WB).points.distance;
      ProximityHint hint;
      for (const double part : {0.0, 0.3, 0.7, 0.999, 1.001, 2.0}) {
        const Separation sut = separation(a, X_WA, *other, X_WB, part * exact, hint);
        if (exact == 0) {
          EXPECT_EQ(sut.points.distance, 0);
          EXPECT_FALSE(sut.beyond);
        } else if (part < 1) {
          EXPECT_TRUE(sut.beyond);
          EXPECT_GE(sut.points.distance, part * exact);
          EXPECT_LE(sut.points.distance, exact + 1e-9);
        } else {
          EXPECT_FALSE(sut.beyond);
          EXPECT_NEAR(sut.points.distance, exact, 1e-9);
        }
      }
    }
  }
}

TEST(Separation, IsZeroForWhatTouchesOrIsIdentical) {
  const Solid a = make_mesh_solid(share(test::box_mesh(kUnitBox)));
  EXPECT_EQ(distance(a, at(0, 0, 0), a, at(0, 0, 0)).points.distance, 0);
  EXPECT_EQ(distance(a, at(0, 0, 0), a, at(1, 0, 0)).points.distance, 0);     // face on face
  EXPECT_EQ(distance(a, at(0, 0, 0), a, at(1, 1, 0)).points.distance, 0);     // edge on edge
  EXPECT_EQ(distance(a, at(0, 0, 0), a, at(1, 1, 1)).points.distance, 0);     // corner on corner
  EXPECT_EQ(distance(a, at(0, 0, 0), a, at(0.25, 0, 0)).points.distance, 0);  // four sides in common planes
  EXPECT_TRUE(touching(a, at(0, 0, 0), a, at(1, 0, 0)));
  EXPECT_TRUE(touching(a, at(0, 0, 0), a, at(1 + 0.5e-9, 0, 0)));
  EXPECT_FALSE(touching(a, at(0, 0, 0), a, at(1 + 2e-9, 0, 0)));
  const Separation near = distance(a, at(0, 0, 0), a, at(1 + 1e-6, 0, 0));
  EXPECT_NEAR(near.points.distance, 1e-6, 1e-15);
}

TEST(Separation, OfFlatSheetsIsTheirGap) {
  const Solid a = make_mesh_solid(share(test::sheet(1, 20)));
  EXPECT_NEAR(distance(a, at(0, 0, 0), a, at(0.3, 0.2, 0.01)).points.distance, 0.01, 1e-15);
  EXPECT_LT(distance(a, at(0, 0, 0), a, at(0.03, 0.02, 0)).points.distance, 1e-15);
  EXPECT_NEAR(distance(a, at(0, 0, 0), a, at(1.5, 0, 0)).points.distance, 0.5, 1e-15);
}

TEST(Separation, HoldsAtEveryScaleAndFarFromTheOrigin) {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e5}) {
    const Solid a = make_mesh_solid(share(test::box_mesh(scale * kUnitBox)));
    const Solid b = make_mesh_solid(share(test::icosphere(0.5 * scale, 3)));
    const Separation sut = distance(a, at(0, 0, 0), b, at(2 * scale, 0, 0));
    double nearest = kInfinity;
    for (const Vector3d& p : b.tree->mesh().vertices) nearest = std::min(nearest, 2 * scale + p.x() - 0.5 * scale);
    EXPECT_NEAR(sut.points.distance, nearest, 1e-12 * scale);
  }
  const Solid a = make_mesh_solid(share(test::box_mesh(kUnitBox, {1e5, -1e5, 1e5})));
  EXPECT_NEAR(distance(a, at(0, 0, 0), a, at(1.25, 0, 0)).points.distance, 0.25, 1e-10);
  const Solid small = make_mesh_solid(share(test::box_mesh({1e-4, 1e-4, 1e-4})));
  const Solid large = make_mesh_solid(share(test::box_mesh({1e3, 1e3, 1e3})));
  EXPECT_NEAR(distance(large, at(0, 0, 0), small, at(500.001, 3, 4)).points.distance, 0.001 - 0.5e-4, 1e-10);
}

TEST(Separation, OfAPoseThatIsNoneIsADoubt) {
  const Solid a = make_mesh_solid(share(test::box_mesh(kUnitBox)));
  const Separation sut = distance(a, at(std::nan(""), 0, 0), a, at(9, 9, 9));
  EXPECT_FALSE(sut.certain);
  EXPECT_EQ(sut.points.distance, 0);
  EXPECT_TRUE(touching(a, at(std::nan(""), 0, 0), a, at(9, 9, 9)));
}

TEST(Inside, ABodyInsideOfAClosedMeshTouchesIt) {
  const Solid shell = make_mesh_solid(share(test::icosphere(1, 3)));
  const Solid small = make_mesh_solid(share(test::box_mesh({0.2, 0.2, 0.2})));
  const Solid ball = make_primitive(Shape::sphere, {0.1, 0, 0});
  for (const Solid* inner : {&small, &ball}) {
    const Separation sut = distance(shell, at(0, 0, 0), *inner, at(0.1, 0.2, 0.3));
    EXPECT_EQ(sut.points.distance, 0);
    EXPECT_FALSE(sut.beyond);
    EXPECT_EQ(sut.points.p_a, sut.points.p_b);
    EXPECT_LT((sut.points.p_a - Vector3d(0.1, 0.2, 0.3)).norm(), 0.3);
    EXPECT_TRUE(touching(shell, at(0, 0, 0), *inner, at(0.1, 0.2, 0.3)));
    EXPECT_TRUE(touching(*inner, at(0.1, 0.2, 0.3), shell, at(0, 0, 0)));
    EXPECT_FALSE(touching(*inner, at(1.3, 0.2, 0.3), shell, at(0, 0, 0)));
  }
}

TEST(Inside, AMeshInsideOfAPrimitiveTouchesItEvenIfItIsOpen) {
  const Solid box = make_primitive(Shape::box, {1, 1, 1});
  EXPECT_TRUE(touching(make_mesh_solid(share(test::box_mesh({0.2, 0.2, 0.2}))), at(0, 0, 0), box, at(0.1, 0, 0)));
  EXPECT_TRUE(touching(make_mesh_solid(share(test::sheet(0.2, 3))), at(0, 0, 0), box, at(0.1, 0, 0)));
}

TEST(Inside, AnOpenMeshHasNone) {
  TriangleMesh open = test::icosphere(1, 2);
  open.triangles.pop_back();
  open.closed = false;
  const Solid surface = make_mesh_solid(share(open));
  const Solid ball = make_primitive(Shape::sphere, {0.1, 0, 0});
  EXPECT_FALSE(touching(surface, at(0, 0, 0), ball, at(0, 0, 0)));
  EXPECT_NEAR(distance(surface, at(0, 0, 0), ball, at(0, 0, 0)).points.distance, 0.85, 0.05);
}

TEST(Inside, EachShellOfAMeshIsAsked) {
  const Solid two = make_mesh_solid(
      share(test::joined(test::box_mesh({0.1, 0.1, 0.1}, {-5, 0, 0}), test::box_mesh({0.1, 0.1, 0.1}, {0.1, 0, 0}))));
  const Solid shell = make_mesh_solid(share(test::icosphere(1, 2)));
  EXPECT_TRUE(touching(two, at(0, 0, 0), shell, at(0, 0, 0)));
  EXPECT_TRUE(touching(two, at(0, 0, 0), shell, at(-5, 0, 0)));
  EXPECT_FALSE(touching(two, at(0, 0, 0), shell, at(-2.5, 0, 0)));
}

TEST(Inside, ACavityIsOutsideAndOverlappingShellsAreInside) {
  const Solid hollow =
      make_mesh_solid(share(test::joined(test::icosphere(1, 3), test::turned_inside_out(test::icosphere(0.8, 3)))));
  const Solid ball = make_primitive(Shape::sphere, {0.05, 0, 0});
  const Solid cube = make_mesh_solid(share(test::box_mesh({0.05, 0.05, 0.05})));
  for (const Solid* inner : {&ball, &cube}) {
    EXPECT_FALSE(touching(hollow, at(0, 0, 0), *inner, at(0, 0, 0)));
    EXPECT_TRUE(touching(hollow, at(0, 0, 0), *inner, at(0.9, 0, 0)));
  }
  const Solid twice =
      make_mesh_solid(share(test::joined(test::box_mesh(kUnitBox), test::box_mesh(kUnitBox, {0.5, 0, 0}))));
  for (const double x : {-0.4, 0.25, 0.9}) EXPECT_TRUE(touching(twice, at(0, 0, 0), ball, at(x, 0.1, 0.2)));
}

TEST(Inside, IsRightForPointsInLineWithCornersAndEdges) {
  const Solid box = make_mesh_solid(share(test::box_mesh({2, 2, 2})));
  const Solid ring = make_mesh_solid(share(test::torus(1, 0.25, 24, 12)));
  const Solid dot = make_primitive(Shape::sphere, {1e-6, 0, 0});
  for (const double x : {-0.5, 0.0, 0.5}) {
    for (const double y : {-0.5, 0.0, 0.5}) {
      for (const double z : {-0.5, 0.0, 0.5}) EXPECT_TRUE(touching(box, at(0, 0, 0), dot, at(x, y, z)));
    }
  }
  EXPECT_FALSE(touching(ring, at(0, 0, 0), dot, at(0, 0, 0)));
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * std::numbers::pi * i / 24;
    EXPECT_TRUE(touching(ring, at(0, 0, 0), dot, at(std::cos(angle), std::sin(angle), 0)));
    EXPECT_FALSE(touching(ring, at(0, 0, 0), dot, at(1.3 * std::cos(angle), 1.3 * std::sin(angle), 0)));
  }
}

}  // namespace
}  // namespace cellmirror::geometry
