// Shapes prepared for queries.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "rt_core/geometry/solid.hpp"
#include "tests/support/geometry_oracle/meshes.hpp"
#include "tests/unit/geometry_convex/shapes.hpp"

namespace cellmirror::geometry {
namespace {

using Eigen::Vector3d;

TEST(MakePrimitive, takesSizesAsGeometryDoes) {
  const Solid box_solid = make_primitive(Shape::box, {2, 4, 6});
  EXPECT_EQ(box_solid.core.kind, CoreKind::box);
  EXPECT_EQ(box_solid.core.half, Vector3d(1, 2, 3));
  const Solid sphere_solid = make_primitive(Shape::sphere, {0.5, 0, 0});
  EXPECT_EQ(sphere_solid.core.skin, 0.5);
  const Solid capsule_solid = make_primitive(Shape::capsule, {0.5, 3, 0});
  EXPECT_EQ(capsule_solid.core.half.z(), 1.5);
  EXPECT_EQ(capsule_solid.half, Vector3d(0.5, 0.5, 2));
  const Solid cylinder_solid = make_primitive(Shape::cylinder, {0.5, 3, 0});
  EXPECT_EQ(cylinder_solid.core.half, Vector3d(0.5, 0.5, 1.5));
}

TEST(MakePrimitive, isHeldByItsBoxAndItsSphere) {
  AnyShapes any(1);
  for (const Shape shape : {Shape::box, Shape::cylinder, Shape::sphere, Shape::capsule}) {
    const Solid sut = make_primitive(shape, {0.3, 0.8, 1.1});
    double greatest = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double far = reach(sut.core, Pose::Identity(), any.direction());
      ASSERT_LE(far, sut.radius + 1e-12);
      greatest = std::max(greatest, far);
    }
    EXPECT_GT(greatest, 0.9 * sut.radius);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(reach(sut.core, Pose::Identity(), Vector3d::Unit(i)), sut.half[i], 1e-12);
  }
}

TEST(SolidLibrary, sharesEqualShapesAndForgetsThem) {
  SolidLibrary sut;
  auto first = sut.primitive(Shape::box, {1, 2, 3});
  EXPECT_EQ(sut.primitive(Shape::box, {1, 2, 3}), first);
  EXPECT_NE(sut.primitive(Shape::box, {1, 2, 4}), first);
  EXPECT_NE(sut.primitive(Shape::cylinder, {1, 2, 3}), first);
  const auto mesh = geometry_oracle::shared(geometry_oracle::box_mesh({1, 2, 3}));
  auto solid = sut.mesh(mesh);
  EXPECT_EQ(sut.mesh(mesh), solid);
  EXPECT_EQ(solid->half, Vector3d(1, 2, 3));
  EXPECT_NEAR(solid->radius, std::sqrt(14.0), 1e-12);
  const std::weak_ptr<const Solid> watched = solid;
  solid.reset();
  EXPECT_TRUE(watched.expired());
  EXPECT_NE(sut.mesh(mesh), nullptr);
}

}  // namespace
}  // namespace cellmirror::geometry
