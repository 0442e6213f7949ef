// Random arms of each family, with frames anywhere: 10,000 targets a family and direction.
#include <gtest/gtest.h>

#include <functional>

#include "closed_form_checks.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using namespace test;

constexpr unsigned kArms = 10;
constexpr std::size_t kTargets = 1000;

void expect_family_found(bool from_tip, const std::function<std::vector<Axis>(Random&)>& make) {
  for (unsigned seed = 1; seed <= kArms; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::vector<Axis> axes = make(random);
    const kinematics::Chain chain = chain_of_axes(from_tip ? from_tip_to_base(axes) : axes, random);
    const auto sut = ClosedForm::analyse(chain);
    ASSERT_TRUE(sut);
    EXPECT_TRUE(sut->exact());
    EXPECT_EQ(sut->from_tip(), from_tip);
    expect_all_found(*sut, chain, kTargets, seed);
  }
}

class ClosedFormRandomArms : public testing::TestWithParam<bool> {
 protected:
  static void expect_found(Shoulder shoulder) {
    expect_family_found(GetParam(), [&](Random& random) { return wrist_arm(shoulder, random); });
  }
};
INSTANTIATE_TEST_SUITE_P(Direction, ClosedFormRandomArms, testing::Bool(),
                         [](const auto& direction) { return direction.param ? "FromTip" : "FromBase"; });

TEST_P(ClosedFormRandomArms, WristWithAxes2And3Parallel) { expect_found(Shoulder::parallel_23); }
TEST_P(ClosedFormRandomArms, WristWithAxes1And2Intersecting) { expect_found(Shoulder::intersecting_12); }
TEST_P(ClosedFormRandomArms, WristWithAxes1And2Parallel) { expect_found(Shoulder::parallel_12); }
TEST_P(ClosedFormRandomArms, WristWithAxes2And3Intersecting) { expect_found(Shoulder::intersecting_23); }
TEST_P(ClosedFormRandomArms, WristAlone) { expect_found(Shoulder::general); }
TEST_P(ClosedFormRandomArms, ThreeParallelAxesAndIntersecting) {
  expect_family_found(GetParam(), [](Random& random) { return parallel_arm(true, random); });
}
TEST_P(ClosedFormRandomArms, ThreeParallelAxesAlone) {
  expect_family_found(GetParam(), [](Random& random) { return parallel_arm(false, random); });
}

// Spherical shoulder, elbow, spherical wrist; and with a wrist that has an offset.
TEST(ClosedFormRedundantArms, TakesTheFreeJointFromTheNearPosture) {
  for (unsigned seed = 1; seed <= kArms; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<Axis> axes(7);
    for (std::size_t i = 0; i < 3; ++i) axes[i].o = Vector::Zero();
    axes[3].o = random.vector(0.5);
    for (std::size_t i = 4; i < 7; ++i) axes[i].o = Vector(0.3, 0.2, 0.7);
    if (seed % 2 == 0) axes[6].o += random.vector(0.2);
    axes[0].h = random.direction();
    for (std::size_t i = 1; i < 7; ++i) axes[i].h = random.direction_across(axes[i - 1].h);
    const kinematics::Chain chain = chain_of_axes(axes, random);
    const auto sut = ClosedForm::analyse_redundant(chain);
    ASSERT_TRUE(sut);
    EXPECT_TRUE(sut->exact());
    ASSERT_EQ(sut->free_joint(), 6U);
    expect_all_found(*sut, chain, kTargets, seed);
    EXPECT_FALSE(ClosedForm::analyse(chain));

    // The same arm turned round: the first joint is the free one.
    const kinematics::Chain turned_round = chain_of_axes(from_tip_to_base(axes), random);
    const auto round = ClosedForm::analyse_redundant(turned_round);
    ASSERT_TRUE(round);
    EXPECT_TRUE(seed % 2 == 1 || round->free_joint() == 0U);
    expect_all_found(*round, turned_round, kTargets, seed);
  }
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
