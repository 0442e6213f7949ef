#include "rt_core/kinematics/tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/kinematics/chain_support.hpp"

namespace cellmirror::kinematics {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

TreeLink fixed_link(std::string name, std::int32_t parent, const Pose& X_PL) {
  return {std::move(name), parent, X_PL, std::nullopt};
}
TreeLink moved_link(std::string name, std::int32_t parent, const Pose& X_PL, const TreeJoint& joint) {
  return {std::move(name), parent, X_PL, joint};
}

// A slide along y carries a gripper: two fingers, the second one a mimic of the first against it.
Tree gripper() {
  std::vector<TreeLink> links;
  links.push_back(fixed_link("stand", Tree::kRoot, translation(0, 0, 1)));
  links.push_back(moved_link("slide", 0, Pose::Identity(), {JointKind::prismatic, Vector3d::UnitY(), 0, 1.0, 0.0}));
  links.push_back(fixed_link("hand", 1, translation(0.5, 0, 0)));
  links.push_back(
      moved_link("finger_1", 2, translation(0, 0.1, 0), {JointKind::revolute, Vector3d::UnitZ(), 1, 1.0, 0.0}));
  links.push_back(
      moved_link("finger_2", 2, translation(0, -0.1, 0), {JointKind::revolute, Vector3d::UnitZ(), 1, -2.0, 0.5}));
  auto tree =
      Tree::make({{"slide", JointKind::prismatic, 0, 2}, {"finger_1", JointKind::revolute, -1, 1}}, std::move(links));
  EXPECT_TRUE(tree) << tree.error().text();
  return std::move(*tree);
}

// Mostly long branches; a variable each, or a mimic of an earlier one.
Tree random_tree(std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  std::vector<TreeLink> links;
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < count; ++i) {
    const auto parent =
        static_cast<std::int32_t>(i) - 1 - static_cast<std::int32_t>(random() % 3 == 0 ? random() % (i + 1) : 0);
    TreeLink link = fixed_link("L" + std::to_string(i), std::max(parent, -1), random_pose(random));
    const Vector3d axis = Vector3d(part(random), part(random), part(random)).normalized();
    const JointKind kind = part(random) < -0.3 ? JointKind::prismatic : JointKind::continuous;
    if (random() % 4 == 0 && !variables.empty()) {
      link.joint =
          TreeJoint{kind, axis, static_cast<std::uint8_t>(random() % variables.size()), part(random), part(random)};
    } else if (random() % 4 != 0 && variables.size() < kMaxVariables) {
      link.joint = TreeJoint{kind, axis, static_cast<std::uint8_t>(variables.size()), 1.0, 0.0};
      variables.push_back({"q" + std::to_string(i), kind, -1, 1});
    }
    links.push_back(std::move(link));
  }
  auto tree = Tree::make(std::move(variables), std::move(links));
  EXPECT_TRUE(tree) << tree.error().text();
  return std::move(*tree);
}

std::vector<Pose> poses_of(const Tree& tree, std::span<const double> q) {
  std::vector<Pose> X_RL(tree.links().size());
  forward(tree, q, X_RL);
  return X_RL;
}

TEST(Tree, movesLinksAndTheirMimics) {
  const Tree sut = gripper();
  const double q[] = {0.7, 0.3};
  const auto X_RL = poses_of(sut, q);
  EXPECT_LT(difference(X_RL[0], translation(0, 0, 1)), 1e-15);
  EXPECT_LT(difference(X_RL[2], translation(0.5, 0.7, 1)), 1e-15);
  EXPECT_LT(difference(X_RL[3], translation(0.5, 0.8, 1) * turn(0.3, Vector3d::UnitZ())), 1e-15);
  EXPECT_LT(difference(X_RL[4], translation(0.5, 0.6, 1) * turn(-0.1, Vector3d::UnitZ())), 1e-15);
}

TEST(Tree, jacobianOfAMimicIsThatOfItsVariableTimesTheFactor) {
  const Tree sut = gripper();
  const double q[] = {0.7, 0.3};
  TreeJacobian J;
  jacobian(sut, poses_of(sut, q), 4, J);
  ASSERT_EQ(J.cols(), 2);
  Eigen::Matrix<double, 6, 2> expected;
  expected << 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, -2;
  EXPECT_LT((J - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Tree, jacobiansAreTheLimitsOfDifferences) {
  std::mt19937_64 random(1);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 20; ++i) {
    const Tree sut = random_tree(12, random);
    auto q = random_values(sut.variables().size(), 2.0, random);
    const auto X_RL = poses_of(sut, q);
    for (std::size_t link = 0; link < X_RL.size(); ++link) {
      TreeJacobian J;
      jacobian(sut, X_RL, link, J);
      for (std::size_t k = 0; k < q.size(); ++k) {
        const double at = q[k];
        q[k] = at + kStep;
        const Pose after = poses_of(sut, q)[link];
        q[k] = at - kStep;
        const Pose before = poses_of(sut, q)[link];
        q[k] = at;
        const Twist rate = pose_error(before, after) / (2 * kStep);
        EXPECT_LT((J.col(static_cast<Eigen::Index>(k)) - rate).cwiseAbs().maxCoeff(), 1e-7);
      }
    }
  }
}

TEST(Tree, chainsBetweenAnyTwoLinksAgreeWithIt) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 50; ++i) {
    const Tree sut = random_tree(14, random);
    const auto q = random_values(sut.variables().size(), 2.0, random);
    const auto X_RL = poses_of(sut, q);
    for (int k = 0; k < 20; ++k) {
      const auto base = static_cast<std::int32_t>(random() % 15) - 1;
      const auto tip = static_cast<std::int32_t>(random() % 15) - 1;
      const auto order = k % 2 == 0 ? VariableOrder::along_chain : VariableOrder::of_tree;
      const auto chain = sut.chain(base, tip, order);
      if (!chain) continue;  // nothing moves between the two
      std::vector<double> values;
      for (const std::uint8_t variable : chain->tree_variable) values.push_back(q[variable]);
      const auto at = [&](std::int32_t link) {
        return link < 0 ? Pose(Pose::Identity()) : X_RL[static_cast<std::size_t>(link)];
      };
      EXPECT_LT(difference(forward(chain->chain, values), at(base).inverse() * at(tip)), 1e-13);
    }
  }
}

TEST(Tree, chainNumbersItsVariablesAsAsked) {
  const Tree sut = gripper();
  const auto along = sut.chain(3, 0, VariableOrder::along_chain);
  ASSERT_TRUE(along);
  EXPECT_THAT(along->tree_variable, testing::ElementsAre(1, 0));
  EXPECT_EQ(along->chain.variables()[0].name, "finger_1");
  EXPECT_TRUE(along->chain.plain());
  const auto as_tree = sut.chain(3, 0, VariableOrder::of_tree);
  ASSERT_TRUE(as_tree);
  EXPECT_THAT(as_tree->tree_variable, testing::ElementsAre(0, 1));
}

TEST(Tree, chainWhereNothingMovesIsRefused) {
  EXPECT_FALSE(gripper().chain(1, 2, VariableOrder::along_chain));
  EXPECT_FALSE(gripper().chain(2, 2, VariableOrder::along_chain));
}

TEST(Tree, leavesTheHeapAlone) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  std::mt19937_64 random(3);
  const Tree sut = random_tree(40, random);
  const auto q = random_values(sut.variables().size(), 2.0, random);
  std::vector<Pose> X_RL(sut.links().size());
  TreeJacobian J;
  const AllocationGuard guard;
  forward(sut, q, X_RL);
  jacobian(sut, X_RL, 39, J);
  EXPECT_EQ(guard.allocations(), 0U);
}

// --- What is refused, and how it is told.

std::string refusal(const std::vector<Variable>& variables, const TreeLink& link) {
  const auto tree = Tree::make(variables, {link});
  return tree ? "accepted" : tree.error().what;
}

TEST(Tree, refusesWhatIsNoJoint) {
  const std::vector<Variable> one{{"q", JointKind::revolute, -1, 1}};
  const Pose X = Pose::Identity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto joint = [](const Vector3d& axis, std::uint8_t variable, double factor) {
    return TreeJoint{JointKind::revolute, axis, variable, factor, 0.0};
  };
  EXPECT_EQ(refusal(one, moved_link("a", -1, X, joint(Vector3d::UnitX(), 0, 1))), "accepted");
  EXPECT_THAT(refusal(one, moved_link("elbow", -1, X, joint(Vector3d::Zero(), 0, 1))),
              AllOf(HasSubstr("elbow"), HasSubstr("axis"), HasSubstr("length 0")));
  EXPECT_THAT(refusal(one, moved_link("elbow", -1, X, joint(Vector3d(nan, 0, 0), 0, 1))), HasSubstr("axis"));
  EXPECT_THAT(refusal(one, moved_link("elbow", -1, X, joint(Vector3d::UnitX(), 1, 1))), HasSubstr("elbow"));
  EXPECT_THAT(refusal(one, moved_link("elbow", -1, X, joint(Vector3d::UnitX(), 0, nan))), HasSubstr("factor"));
}

TEST(Tree, refusesLinksInTheWrongPlace) {
  EXPECT_THAT(refusal({}, fixed_link("a", 0, Pose::Identity())), HasSubstr("after its parent"));
  Pose mirrored = Pose::Identity();
  mirrored.linear()(2, 2) = -1;
  EXPECT_THAT(refusal({}, fixed_link("a", -1, mirrored)), HasSubstr("not a rotation"));
}

TEST(Tree, refusesLimitsTheWrongWayRound) {
  EXPECT_THAT(refusal({{"wrist", JointKind::revolute, 1, -1}}, fixed_link("a", -1, Pose::Identity())),
              AllOf(HasSubstr("wrist"), HasSubstr("swapped limits")));
}

TEST(Tree, refusesMoreThanItsCapacities) {
  EXPECT_FALSE(Tree::make({}, std::vector<TreeLink>(kMaxTreeLinks + 1)));
  const std::vector<Variable> many(kMaxTreeVariables + 1, {"q", JointKind::revolute, -1, 1});
  EXPECT_FALSE(Tree::make(many, {}));
}

}  // namespace
}  // namespace cellmirror::kinematics
