// FCL's verdict beside ours: what it must see, and what it may see differently.
#include "rt_core/collision/second_opinion.hpp"

#include <gtest/gtest.h>

namespace cellmirror::collision {
namespace {

std::shared_ptr<const geometry::TriangleMesh> cube(double half) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half, (i & 4) != 0 ? half : -half);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  mesh.closed = true;
  return std::make_shared<const geometry::TriangleMesh>(std::move(mesh));
}

struct SecondOpinionTest : testing::Test {
  static Body body(std::shared_ptr<const geometry::Solid> solid) { return {0, {{std::move(solid), Pose::Identity()}}}; }
  Body mesh(double half) { return body(solids.mesh(keep.emplace_back(cube(half)))); }
  Body sphere(double radius) { return body(solids.primitive(Shape::sphere, {radius, 0, 0})); }

  Opinion ask(const Body& a, const Body& b, double x, const OwnVerdict& own) {
    return sut.ask(a, Pose::Identity(), b, Pose(Eigen::Translation3d(x, 0, 0)), own);
  }

  geometry::SolidLibrary solids;
  std::vector<std::shared_ptr<const geometry::TriangleMesh>> keep;
  SecondOpinion sut;
};

constexpr OwnVerdict kTouching{true, 0.0, 0.05};
constexpr OwnVerdict kApart{false, 0.05, 0.0};

TEST_F(SecondOpinionTest, SeesPrimitives) {
  EXPECT_EQ(ask(sphere(0.5), sphere(0.5), 0.9, kTouching), Opinion::agrees);
  EXPECT_EQ(ask(sphere(0.5), sphere(0.5), 1.1, kApart), Opinion::agrees);
  EXPECT_EQ(ask(sphere(0.5), sphere(0.5), 0.9, kApart), Opinion::disagrees);
  EXPECT_EQ(ask(sphere(0.5), sphere(0.5), 1.1, kTouching), Opinion::disagrees);
}

TEST_F(SecondOpinionTest, SeesMeshes) {
  EXPECT_EQ(ask(mesh(0.5), mesh(0.5), 0.9, kTouching), Opinion::agrees);
  EXPECT_EQ(ask(mesh(0.5), mesh(0.5), 1.1, kApart), Opinion::agrees);
  EXPECT_EQ(ask(mesh(0.5), sphere(0.5), 0.9, kApart), Opinion::disagrees);
  EXPECT_EQ(ask(mesh(0.5), sphere(0.5), 1.1, kTouching), Opinion::disagrees);
}

TEST_F(SecondOpinionTest, KnowsThatMeshesAreSurfacesToFcl) {
  EXPECT_EQ(ask(mesh(1.0), mesh(0.2), 0.1, kTouching), Opinion::agrees);
  EXPECT_EQ(ask(mesh(1.0), sphere(0.2), 0.1, kTouching), Opinion::agrees);
  EXPECT_EQ(ask(sphere(1.0), mesh(0.2), 0.1, kTouching), Opinion::agrees);
}

TEST_F(SecondOpinionTest, DoesNotQuarrelAboutAMicrometre) {
  EXPECT_EQ(ask(sphere(0.5), sphere(0.5), 1.0 + 1e-7, {true, 0.0, 0.0}), Opinion::agrees);
  EXPECT_EQ(ask(sphere(0.5), sphere(0.5), 1.0 - 1e-7, {false, 1e-7, 0.0}), Opinion::agrees);
}

TEST_F(SecondOpinionTest, LooksAtEveryPart) {
  Body two = sphere(0.1);
  two.parts.push_back({solids.primitive(Shape::box, {0.2, 0.2, 0.2}), Pose(Eigen::Translation3d(1.0, 0, 0))});
  EXPECT_EQ(ask(two, sphere(0.1), 0.85, kTouching), Opinion::agrees);
  EXPECT_EQ(ask(two, sphere(0.1), 0.5, kApart), Opinion::agrees);
}

}  // namespace
}  // namespace cellmirror::collision
