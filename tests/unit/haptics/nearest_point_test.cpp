#include "rt_core/haptics/nearest_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "rig.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Vector3d;
using test_rig::model_of;
using test_rig::plane;

TEST(NearestPoint, IsTheGoalWhereNothingIsInTheWay) {
  const Vector3d goal(0.1, -0.2, 0.3);
  EXPECT_EQ(nearest_point(model_of({}, Vector3d::Zero()), goal).x, goal);
  const NearestPoint sut = nearest_point(model_of({plane(Vector3d::UnitZ(), 0.0, Vector3d::Zero())}, goal), goal);
  EXPECT_EQ(sut.x, goal);
  EXPECT_EQ(sut.active_count, 0);
}

TEST(NearestPoint, IsTheFootOnAPlaneWhateverTheLengthOfItsNormal) {
  for (const double length : {0.02, 0.3, 1.0, 7.0}) {
    const Vector3d a(0, 0, length);
    const ContactModel model = model_of({plane(a, 0.1 * length, Vector3d(0.4, 0, 0.2))}, Vector3d(0.4, 0, 0.2));
    const NearestPoint sut = nearest_point(model, Vector3d(0.3, -0.1, 0.05));
    EXPECT_LT((sut.x - Vector3d(0.3, -0.1, 0.1)).norm(), 1e-12) << length;
    ASSERT_EQ(sut.active_count, 1);
    EXPECT_NEAR(sut.multiplier[0] * length, 0.05, 1e-12);
  }
}

TEST(NearestPoint, StandsInTheCornerOfTwoAndOfThreePlanes) {
  const Vector3d slanted = Vector3d(1, 0, 1).normalized();
  const std::vector<ContactConstraint> planes = {plane(Vector3d::UnitX(), 0, Vector3d::Zero()),
                                                 plane(Vector3d::UnitY(), 0, Vector3d::Zero()),
                                                 plane(slanted, 0, Vector3d::Zero())};
  const NearestPoint edge =
      nearest_point(model_of({planes[0], planes[1]}, Vector3d::Zero()), Vector3d(-0.01, -0.02, 0.5));
  EXPECT_LT((edge.x - Vector3d(0, 0, 0.5)).norm(), 1e-12);
  EXPECT_EQ(edge.active_count, 2);
  const NearestPoint corner = nearest_point(model_of(planes, Vector3d::Zero()), Vector3d(-0.03, -0.02, -0.01));
  EXPECT_LT(corner.x.norm(), 1e-12);
  EXPECT_EQ(corner.active_count, 3);
}

TEST(NearestPoint, SaysWhereNoPointMeetsThemAll) {
  const ContactModel model =
      model_of({plane(Vector3d::UnitX(), 0.01, Vector3d::Zero()), plane(-Vector3d::UnitX(), 0.01, Vector3d::Zero())},
               Vector3d::Zero());
  EXPECT_FALSE(nearest_point(model, Vector3d(0.3, 0, 0)).found);
}

TEST(NearestPoint, LeavesOutNormalsThatSayNothing) {
  ContactModel model =
      model_of({plane(Vector3d::Zero(), 0.5, Vector3d::Zero()), plane(Vector3d::UnitZ(), 0.0, Vector3d::Zero())},
               Vector3d::Zero());
  model.constraints[0].a.x() = std::numeric_limits<double>::quiet_NaN();
  const NearestPoint sut = nearest_point(model, Vector3d(0, 0, -0.1));
  EXPECT_TRUE(sut.found);
  EXPECT_LT(sut.x.norm(), 1e-12);
}

// The conditions of Karush, Kuhn and Tucker are necessary and sufficient here, so that meeting them proves the answer.
TEST(NearestPoint, MeetsTheConditionsOfOptimalityOnRandomModels) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> how_many(1, static_cast<int>(kMaxConstraints));
  std::array<int, 4> active{};
  for (int round = 0; round < 20'000; ++round) {
    std::vector<ContactConstraint> planes;
    const Vector3d x_ref(normal(random), normal(random), normal(random));
    const int count = how_many(random);
    for (int i = 0; i < count; ++i) {
      const Vector3d a(normal(random), normal(random), normal(random));
      ContactConstraint made = plane(a, 0, x_ref);
      made.gap = 0.02 * std::abs(normal(random));  // x_ref itself is free
      planes.push_back(made);
    }
    const ContactModel model = model_of(planes, x_ref);
    const Vector3d goal = x_ref + 0.1 * Vector3d(normal(random), normal(random), normal(random));
    const NearestPoint sut = nearest_point(model, goal);
    ASSERT_TRUE(sut.found);
    ASSERT_LE(violation(model, sut.x), 1e-6);
    Vector3d pushed = goal;
    for (std::size_t k = 0; k < sut.active_count; ++k) {
      const ContactConstraint& held = model.constraints[sut.active[k]];
      ASSERT_GT(sut.multiplier[k], 0);
      ASSERT_NEAR(held.a.dot(sut.x - x_ref) + held.gap, 0, 1e-6);
      pushed += sut.multiplier[k] * held.a;
    }
    ASSERT_LT((pushed - sut.x).norm(), 1e-9);
    ++active[sut.active_count];
  }
  for (const int often : active) EXPECT_GT(often, 500);
}

}  // namespace
}  // namespace cellmirror::haptics
