// Distances and depths of primitives against Bullet's, another implementation in double precision.
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "rt_core/geometry/convex.hpp"
#include "tests/unit/geometry_convex/shapes.hpp"

namespace cellmirror::geometry {
namespace {

struct Peer {
  ConvexCore core;
  std::unique_ptr<btConvexShape> shape;
};

btVector3 vector_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

btTransform transform_of(const Pose& X) {
  const Eigen::Matrix3d R = X.linear();
  return btTransform(btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
                     vector_of(X.translation()));
}

Peer any_peer(std::size_t kind, AnyShapes& any) {
  Peer out;
  const double x = 0.1 + any.size();
  const double y = 0.1 + any.size();
  const double z = 0.1 + any.size();
  switch (kind) {
    case 0:
      out = {sphere(x), std::make_unique<btSphereShape>(x)};
      return out;
    case 1:
      out = {capsule(x, z), std::make_unique<btCapsuleShapeZ>(x, 2.0 * z)};
      return out;
    case 2:
      out = {box(x, y, z), std::make_unique<btBoxShape>(btVector3(x, y, z))};
      break;
    case 3:
      out = {cylinder(x, z), std::make_unique<btCylinderShapeZ>(btVector3(x, x, z))};
      break;
    default: {
      const Eigen::Vector3d a = 0.5 * any.vector();
      const Eigen::Vector3d b = 0.5 * any.vector();
      const Eigen::Vector3d c = 0.5 * any.vector();
      out = {triangle(a, b, c), std::make_unique<btTriangleShape>(vector_of(a), vector_of(b), vector_of(c))};
    }
  }
  out.shape->setMargin(0.0);
  return out;
}

// Negative: the depth.
double bullet_distance(const Peer& a, const Pose& X_WA, const Peer& b, const Pose& X_WB) {
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth;
  btGjkPairDetector detector(a.shape.get(), b.shape.get(), &simplex, &depth);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = transform_of(X_WA);
  input.m_transformB = transform_of(X_WB);
  btPointCollector out;
  detector.getClosestPoints(input, out, nullptr);
  return out.m_hasResult ? out.m_distance : std::numeric_limits<double>::quiet_NaN();
}

TEST(ConvexDistance, agreesWithBullet) {
  AnyShapes any(31);
  int compared = 0;
  for (std::size_t kind_a = 0; kind_a < 5; ++kind_a) {
    for (std::size_t kind_b = 0; kind_b < 5; ++kind_b) {
      for (int i = 0; i < 200; ++i) {
        const Peer a = any_peer(kind_a, any);
        const Peer b = any_peer(kind_b, any);
        const Pose X_WA = any.pose(0.9);
        const Pose X_WB = any.pose(0.9);
        const double expected = bullet_distance(a, X_WA, b, X_WB);
        if (!(expected > 1e-3)) continue;  // near touch Bullet changes its way of computing
        ++compared;
        // Bullet stops early on cylinders, always a little too far away.
        const double found = convex_distance(a.core, X_WA, b.core, X_WB).points.distance;
        EXPECT_NEAR(found, expected, kind_a == 3 && kind_b == 3 ? 2e-4 : 1e-5)
            << name(a.core.kind) << ' ' << name(b.core.kind);
        EXPECT_LT(found, expected + 1e-8) << name(a.core.kind) << ' ' << name(b.core.kind);
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

// Bullet expands a polytope until it is near enough, which ends early at times.
TEST(ConvexPenetration, isNearlyAlwaysAsBulletFindsIt) {
  AnyShapes any(32);
  int compared = 0;
  int same = 0;
  for (std::size_t kind_a = 0; kind_a < 4; ++kind_a) {
    for (std::size_t kind_b = 0; kind_b < 4; ++kind_b) {
      for (int i = 0; i < 200; ++i) {
        const Peer a = any_peer(kind_a, any);
        const Peer b = any_peer(kind_b, any);
        const Pose X_WA = any.pose(0.4);
        const Pose X_WB = any.pose(0.4);
        const double expected = -bullet_distance(a, X_WA, b, X_WB);
        if (!(expected > 1e-3)) continue;
        ++compared;
        const double found = convex_penetration(a.core, X_WA, b.core, X_WB).depth;
        // At times its depth is too small, too: then no direction parts the two by so little.
        for (int k = 0; k < 20000 && found > expected + 2e-3; ++k) {
          const Eigen::Vector3d way = any.direction();
          ASSERT_GE(reach(a.core, X_WA, way) + reach(b.core, X_WB, -way), found - 1e-9);
        }
        same += std::abs(found - expected) < 2e-3 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_GT(same, compared * 9 / 10) << compared;
}

}  // namespace
}  // namespace cellmirror::geometry
