// Points, segments and triangles against each other: cases known by hand, and the slow answers of the oracle.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "rt_core/geometry/triangle.hpp"
#include "tests/support/geometry_oracle/brute_force.hpp"

namespace cellmirror::geometry {
namespace {

using Eigen::Vector3d;
using geometry_oracle::corners_of;

const Triangle kFloor{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};

Triangle moved(const Triangle& t, const Vector3d& by) { return {t[0] + by, t[1] + by, t[2] + by}; }

double off(const Vector3d& p, const Triangle& t) {
  return static_cast<double>(geometry_oracle::distance(corners_of({p, p, p}), corners_of(t)));
}

void expect_nearest(const ClosestPoints& answer, const Triangle& a, const Triangle& b, double tolerance) {
  const double expected = static_cast<double>(geometry_oracle::distance(corners_of(a), corners_of(b)));
  EXPECT_NEAR(answer.distance, expected, tolerance);
  EXPECT_NEAR((answer.p_a - answer.p_b).norm(), answer.distance, tolerance);
  EXPECT_LE(off(answer.p_a, a), tolerance);
  EXPECT_LE(off(answer.p_b, b), tolerance);
}

struct Random {
  std::mt19937_64 engine{7};
  std::uniform_real_distribution<double> part{-1.0, 1.0};
  Vector3d vector() { return {part(engine), part(engine), part(engine)}; }
  Triangle triangle() { return {vector(), vector(), vector()}; }
  // Often flat, a needle, or with corners that are equal or lie in a line or on a grid.
  Triangle odd_triangle() {
    Triangle t = triangle();
    switch (engine() % 6) {
      case 0:
        t[1] = t[0];
        break;
      case 1:
        t[2] = 0.25 * t[0] + 0.75 * t[1];
        break;
      case 2:
        t[2] = t[1] + 1e-7 * vector();
        break;
      case 3:
        t[2] = 0.5 * (t[0] + t[1]) + 1e-11 * vector();
        break;
      case 4:
        t = {t[0], t[0], t[0]};
        break;
      default:
        for (Vector3d& corner : t) corner = (2.0 * corner).array().round().matrix();
    }
    return t;
  }
};

TEST(ClosestOnTriangle, isAFaceAnEdgeOrACorner) {
  EXPECT_EQ(closest_on_triangle({0.25, 0.25, 3}, kFloor), Vector3d(0.25, 0.25, 0));
  EXPECT_EQ(closest_on_triangle({0.5, -1, 1}, kFloor), Vector3d(0.5, 0, 0));
  EXPECT_EQ(closest_on_triangle({-1, -2, 0}, kFloor), Vector3d(0, 0, 0));
  EXPECT_TRUE(closest_on_triangle({1, 1, 0}, kFloor).isApprox(Vector3d(0.5, 0.5, 0)));
  EXPECT_EQ(closest_on_triangle({2, -0.5, 0}, kFloor), Vector3d(1, 0, 0));
}

TEST(ClosestOnSegment, staysOnTheSegmentAlsoOfNoLength) {
  EXPECT_EQ(closest_on_segment({0.5, 1, 0}, {{0, 0, 0}, {1, 0, 0}}), Vector3d(0.5, 0, 0));
  EXPECT_EQ(closest_on_segment({-5, 1, 0}, {{0, 0, 0}, {1, 0, 0}}), Vector3d(0, 0, 0));
  EXPECT_EQ(closest_on_segment({5, 1, 0}, {{0, 0, 0}, {1, 0, 0}}), Vector3d(1, 0, 0));
  EXPECT_EQ(closest_on_segment({5, 1, 0}, {{2, 2, 2}, {2, 2, 2}}), Vector3d(2, 2, 2));
}

TEST(SegmentSegment, keepsItsDigitsWhereTheyAreNearlyParallel) {
  for (const double angle : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const Segment a{{-1, 0, 0}, {1, 0, 0}};
    const Segment b{{-1, -angle, 0}, {1, angle, 0}};
    EXPECT_LT(segment_segment(a, b).distance, 1e-15) << angle;
    const Segment above{{-1, -angle, 0.25}, {1, angle, 0.25}};
    EXPECT_NEAR(segment_segment(a, above).distance, 0.25, 1e-15) << angle;
  }
  EXPECT_EQ(segment_segment({{0, 0, 0}, {1, 0, 0}}, {{3, 4, 0}, {4, 4, 0}}).distance, std::hypot(2.0, 4.0));
}

TEST(SegmentTriangle, touchesWhereItPierces) {
  const ClosestPoints through = segment_triangle({{0.2, 0.3, 1}, {0.2, 0.3, -1}}, kFloor);
  EXPECT_EQ(through.distance, 0.0);
  EXPECT_TRUE(through.p_a.isApprox(Vector3d(0.2, 0.3, 0)));
  EXPECT_DOUBLE_EQ(segment_triangle({{0.2, 0.3, 1}, {0.2, 0.3, 0.5}}, kFloor).distance, 0.5);
  EXPECT_DOUBLE_EQ(segment_triangle({{-1, -0.5, 0}, {2, -0.5, 0}}, kFloor).distance, 0.5);
}

TEST(TriangleTriangle, agreesWithTheOracleInAnyPose) {
  Random random;
  int touching = 0;
  for (int i = 0; i < 3000; ++i) {
    const Triangle a = random.triangle();
    const Triangle b = moved(random.triangle(), Vector3d(0.7 * (i % 4), 0, 0));
    const ClosestPoints answer = triangle_triangle(a, b);
    expect_nearest(answer, a, b, 2e-14);
    EXPECT_NEAR(triangle_triangle(b, a).distance, answer.distance, 1e-14);
    touching += answer.distance < 1e-12 ? 1 : 0;
  }
  EXPECT_GT(touching, 100);
}

TEST(TriangleTriangle, agreesWithTheOracleWhereTrianglesAreDegenerate) {
  Random random;
  for (int i = 0; i < 4000; ++i) {
    const Triangle a = random.odd_triangle();
    const Triangle b = i % 2 == 0 ? random.odd_triangle() : random.triangle();
    expect_nearest(triangle_triangle(a, b), a, b, 3e-9);
  }
}

TEST(TriangleTriangle, touchesWhereTheyShareAnything) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Triangle a = random.triangle();
    Triangle b = random.triangle();
    b[static_cast<std::size_t>(i % 3)] = a[static_cast<std::size_t>(i % 2)];
    EXPECT_LT(triangle_triangle(a, b).distance, 1e-15);
    b[static_cast<std::size_t>((i + 1) % 3)] = a[2];
    EXPECT_LT(triangle_triangle(a, b).distance, 1e-15);
    EXPECT_LT(triangle_triangle(a, a).distance, 1e-15);
    // Coplanar, one within the other.
    const Vector3d centre = (a[0] + a[1] + a[2]) / 3.0;
    Triangle inner = a;
    for (Vector3d& corner : inner) corner = 0.9 * centre + 0.1 * corner;
    EXPECT_LT(triangle_triangle(a, inner).distance, 1e-15);
    EXPECT_LT(triangle_triangle(inner, a).distance, 1e-15);
  }
}

TEST(TriangleTriangle, holdsFarFromTheOriginAndAtAnySize) {
  Random random;
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (int i = 0; i < 200; ++i) {
      Triangle a = random.triangle();
      Triangle b = moved(random.triangle(), Vector3d(1.5, 0, 0));
      for (Triangle* t : {&a, &b}) {
        for (Vector3d& corner : *t) corner *= scale;
      }
      expect_nearest(triangle_triangle(a, b), a, b, 1e-14 * scale);
      const Vector3d far(1e5 * scale, -2e5 * scale, 3e5 * scale);
      const Triangle far_a = moved(a, far);
      const Triangle far_b = moved(b, far);
      expect_nearest(triangle_triangle(far_a, far_b), far_a, far_b, 1e-9 * scale);
    }
  }
}

TEST(TriangleTriangle, mayStopAtTheBoundThatWasAskedFor) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Triangle a = random.triangle();
    const Triangle b = moved(random.odd_triangle(), Vector3d(0.8, 0, 0));
    const double exact = triangle_triangle(a, b).distance;
    for (const double up_to : {0.0, 0.05, 0.3, 1.0}) {
      const ClosestPoints answer = triangle_triangle(a, b, up_to);
      if (exact < up_to) {
        EXPECT_EQ(answer.distance, exact);
      } else {
        EXPECT_GE(answer.distance, up_to);
        EXPECT_LE(answer.distance, exact + 1e-9);
      }
    }
  }
}

TEST(TriangleTriangle, answersWhateverComesIn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double huge = std::numeric_limits<double>::max();
  for (const double odd : {nan, huge, -huge, std::numeric_limits<double>::infinity()}) {
    Triangle t = kFloor;
    t[1].y() = odd;
    Segment common;
    static_cast<void>(triangle_triangle(t, kFloor));
    static_cast<void>(triangle_triangle(kFloor, t, odd));
    static_cast<void>(triangles_intersect(t, t, common));
    static_cast<void>(segment_triangle({t[0], t[1]}, kFloor));
  }
}

TEST(TrianglesIntersect, givesTheLineThatBothHave) {
  Segment common;
  const Triangle wall{Vector3d(0.25, -1, -1), Vector3d(0.25, 3, -1), Vector3d(0.25, 0.25, 1)};
  ASSERT_TRUE(triangles_intersect(kFloor, wall, common));
  EXPECT_NEAR((common.from - common.to).norm(), 0.75, 1e-15);
  EXPECT_NEAR(std::min(common.from.y(), common.to.y()), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(common.from.x(), 0.25);
  EXPECT_FALSE(triangles_intersect(kFloor, moved(wall, {1, 0, 0}), common));
  EXPECT_FALSE(triangles_intersect(kFloor, moved(kFloor, {0, 0, 1e-9}), common));
}

TEST(TrianglesIntersect, agreesWithDistance) {
  Random random;
  for (int i = 0; i < 3000; ++i) {
    const Triangle a = i % 3 == 0 ? random.odd_triangle() : random.triangle();
    const Triangle b = i % 5 == 0 ? random.odd_triangle() : random.triangle();
    const double exact = static_cast<double>(geometry_oracle::distance(corners_of(a), corners_of(b)));
    if (exact > 0.0 && exact < 1e-9) continue;
    Segment common;
    const bool hit = triangles_intersect(a, b, common);
    ASSERT_EQ(hit, exact < 1e-12) << exact;
    if (!hit) continue;
    for (const Vector3d& p : {common.from, common.to}) {
      EXPECT_LT(off(p, a), 1e-12);
      EXPECT_LT(off(p, b), 1e-12);
    }
  }
}

TEST(TrianglesIntersect, givesAPartOfTheOverlapOfCoplanarTriangles) {
  Segment common;
  ASSERT_TRUE(triangles_intersect(kFloor, moved(kFloor, {0.25, 0.25, 0}), common));
  EXPECT_NEAR((common.from - common.to).norm(), 0.5 * std::sqrt(2.0), 1e-15);
  const Triangle inner{Vector3d(0.1, 0.1, 0), Vector3d(0.3, 0.1, 0), Vector3d(0.1, 0.3, 0)};
  ASSERT_TRUE(triangles_intersect(kFloor, inner, common));
  EXPECT_NEAR((common.from - common.to).norm(), 0.2 * std::sqrt(2.0), 1e-15);
  EXPECT_FALSE(triangles_intersect(kFloor, moved(kFloor, {1.01, 0, 0}), common));
}

}  // namespace
}  // namespace cellmirror::geometry
