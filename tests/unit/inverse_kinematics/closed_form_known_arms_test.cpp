// Published geometries, and what is no arm of a family.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "closed_form_checks.hpp"
#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using namespace test;
using testing::HasSubstr;

TEST(ClosedFormKnownArms, FindsAllPosturesOfThePuma560) {
  const kinematics::Chain chain = puma_560();
  const auto sut = ClosedForm::analyse(chain);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->exact());
  EXPECT_FALSE(sut->from_tip());
  EXPECT_THAT(std::string(sut->family()), HasSubstr("axes 2 and 3 parallel"));
  expect_all_found(*sut, chain, 10'000, 1);
}

TEST(ClosedFormKnownArms, FindsAllPosturesOfTheManutecR3) {
  const kinematics::Chain chain = manutec_r3();
  const auto sut = ClosedForm::analyse(chain);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->exact());
  expect_all_found(*sut, chain, 10'000, 2);
}

TEST(ClosedFormKnownArms, FindsAllPosturesOfTheUr5) {
  const kinematics::Chain chain = ur_5();
  const auto sut = ClosedForm::analyse(chain);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->exact());
  EXPECT_THAT(std::string(sut->family()), HasSubstr("axes 2, 3 and 4 parallel"));
  expect_all_found(*sut, chain, 10'000, 3);
}

// Left and right shoulder, elbow above and below, wrist flipped or not.
TEST(ClosedFormKnownArms, GivesEightDifferentPosturesOfThePuma560) {
  const kinematics::Chain chain = puma_560();
  const auto sut = ClosedForm::analyse(chain);
  ASSERT_TRUE(sut);
  const JointValues nominal{0, 0.25 * std::numbers::pi, std::numbers::pi, 0, 0.25 * std::numbers::pi, 0};
  const Found found = solve(*sut, kinematics::forward(chain, nominal));
  ASSERT_EQ(found.size(), 8U);
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT(distance(found[i], found[k]), 0.1) << i << ' ' << k;
  }
}

TEST(ClosedFormKnownArms, GivesTheSameAnswerToTheSameQuestion) {
  const kinematics::Chain chain = ur_5();
  const auto first = ClosedForm::analyse(chain);
  const auto second = ClosedForm::analyse(chain);
  ASSERT_TRUE(first && second);
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Pose X_BG = kinematics::forward(chain, random_posture(chain, random));
    EXPECT_EQ(solve(*first, X_BG), solve(*second, X_BG));
  }
}

TEST(ClosedFormKnownArms, LeavesTheHeapAlone) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  for (const kinematics::Chain& chain : {puma_560(), ur_5()}) {
    const auto sut = ClosedForm::analyse(chain);
    ASSERT_TRUE(sut);
    const Pose X_BG = kinematics::forward(chain, JointValues{0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
    std::array<JointValues, kMaxClosedForms> out;
    const AllocationGuard guard;
    const std::size_t count = sut->solve(X_BG, out);
    EXPECT_EQ(guard.allocations() + guard.frees(), 0U);
    EXPECT_GT(count, 0U);
  }
}

TEST(ClosedFormKnownArms, FollowsTheTip) {
  Pose X_LT = Pose::Identity();
  X_LT.linear() = rotation_from_rpy(0.3, -0.2, 1.0);
  X_LT.translation() = Vector(0.1, -0.2, 0.3);
  const kinematics::Chain chain = manutec_r3().with_tip(X_LT);
  const auto sut = ClosedForm::analyse(chain);
  ASSERT_TRUE(sut);
  expect_all_found(*sut, chain, 500, 5);
}

// As chains come that are walked against the sense of a joint, or whose zero is moved.
TEST(ClosedFormKnownArms, UnderstandsTurnedSensesAndOffsets) {
  const kinematics::Chain plain = puma_560();
  std::vector<kinematics::ChainJoint> joints(plain.joints().begin(), plain.joints().end());
  joints[1].multiplier = -1;
  joints[4].multiplier = -1;
  joints[2].offset = 0.7;
  joints[5].offset = -2.0;
  const auto chain = kinematics::Chain::make(plain.variables(), joints, plain.X_LT());
  ASSERT_TRUE(chain);
  const auto sut = ClosedForm::analyse(*chain);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->exact());
  expect_all_found(*sut, *chain, 1000, 6);
}

TEST(ClosedFormKnownArms, DeclinesArmsWithoutASpecialArrangement) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    std::vector<Axis> axes;
    for (int i = 0; i < 6; ++i) axes.push_back({random.direction(), random.vector(0.5)});
    EXPECT_FALSE(ClosedForm::analyse(chain_of_axes(axes, random))) << seed;
  }
}

TEST(ClosedFormKnownArms, DeclinesOtherNumbersAndKindsOfJoints) {
  Random random(1);
  for (const std::size_t count : {1, 2, 3, 4, 5, 7, 8}) {
    std::vector<Axis> axes;
    for (std::size_t i = 0; i < count; ++i) axes.push_back({random.direction(), Vector::Zero()});
    const kinematics::Chain chain = chain_of_axes(axes, random);
    EXPECT_FALSE(ClosedForm::analyse(chain)) << count;
    EXPECT_TRUE(count == 7 || !ClosedForm::analyse_redundant(chain)) << count;
  }
  const kinematics::Chain plain = puma_560();
  std::vector<kinematics::Variable> variables = plain.variables();
  std::vector<kinematics::ChainJoint> joints(plain.joints().begin(), plain.joints().end());
  joints[2].kind = JointKind::prismatic;
  variables[2].kind = JointKind::prismatic;
  EXPECT_FALSE(ClosedForm::analyse(kinematics::Chain::make(variables, joints, plain.X_LT()).value()));
}

TEST(ClosedFormKnownArms, DeclinesMimics) {
  const kinematics::Chain plain = puma_560();
  std::vector<kinematics::ChainJoint> joints(plain.joints().begin(), plain.joints().end());
  joints[2].multiplier = 0.5;
  EXPECT_FALSE(ClosedForm::analyse(kinematics::Chain::make(plain.variables(), joints, plain.X_LT()).value()));
  joints[2].multiplier = 1;
  joints.push_back(joints[5]);
  EXPECT_FALSE(ClosedForm::analyse(kinematics::Chain::make(plain.variables(), joints, plain.X_LT()).value()));
}

// Six joints that cannot move the tip freely: all axes parallel, or all through one point.
TEST(ClosedFormKnownArms, DeclinesArmsThatCannotReachPosesOfSixComponents) {
  Random random(2);
  std::vector<Axis> planar;
  std::vector<Axis> spherical;
  for (int i = 0; i < 6; ++i) {
    planar.push_back({Vector::UnitZ(), random.vector(0.5)});
    spherical.push_back({random.direction(), Vector::Zero()});
  }
  EXPECT_FALSE(ClosedForm::analyse(chain_of_axes(planar, random)));
  EXPECT_FALSE(ClosedForm::analyse(chain_of_axes(spherical, random)));
  // The first axis goes on as the second: a spherical wrist on an arm that has one joint too few.
  std::vector<Axis> doubled = wrist_arm(Shoulder::parallel_23, random);
  doubled[0] = doubled[1];
  EXPECT_FALSE(ClosedForm::analyse(chain_of_axes(doubled, random)));
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
