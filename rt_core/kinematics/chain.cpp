#include "rt_core/kinematics/chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cellmirror::kinematics {

namespace {

constexpr double kRotationSlack = 1e-6;

}  // namespace

bool is_pose(const Pose& X) {
  return X.matrix().allFinite() && X.linear().isUnitary(kRotationSlack) && X.linear().determinant() > 0;
}

Result<void> check_limits(const Variable& variable) {
  if (variable.kind == JointKind::continuous) return {};
  if (!std::isfinite(variable.lower) || !std::isfinite(variable.upper)) {
    return fail(fmt::format("joint {} has no finite limits", variable.name), "give it limits, or make it continuous");
  }
  if (variable.lower > variable.upper) {
    return fail(fmt::format("joint {} has swapped limits: lower {} is above upper {}", variable.name, variable.lower,
                            variable.upper),
                "exchange them");
  }
  return {};
}

Result<Chain> Chain::make(std::vector<Variable> variables, std::span<const ChainJoint> joints, const Pose& X_LT) {
  if (variables.empty() || joints.empty()) return fail("the chain has no joint that moves");
  if (variables.size() > kMaxVariables || joints.size() > kMaxChainJoints) {
    return fail(fmt::format("the chain has {} joints ({} with mimics); at most {} ({} with mimics) are possible",
                            variables.size(), joints.size(), kMaxVariables, kMaxChainJoints));
  }
  Chain chain;
  chain.joint_count_ = joints.size();
  chain.variable_count_ = variables.size();
  chain.plain_ = joints.size() == variables.size();
  std::array<bool, kMaxVariables> used{};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const ChainJoint& joint = joints[i];
    if (joint.variable >= variables.size()) return fail(fmt::format("joint {} of the chain has no variable", i + 1));
    if (!is_pose(joint.X_PJ) || !std::isfinite(joint.multiplier) || !std::isfinite(joint.offset)) {
      return fail(fmt::format("joint {} ({}) of the chain has a pose or factor that is not finite", i + 1,
                              variables[joint.variable].name));
    }
    used[joint.variable] = true;
    chain.joints_[i] = joint;
    chain.plain_ = chain.plain_ && joint.variable == i && joint.multiplier == 1.0 && joint.offset == 0.0;
  }
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const Variable& variable = variables[i];
    if (!used[i]) return fail(fmt::format("joint {} does not move the tip", variable.name));
    if (auto checked = check_limits(variable); !checked) return std::unexpected(checked.error());
    const bool free = variable.kind == JointKind::continuous;
    chain.lower_[i] = free ? -std::numeric_limits<double>::infinity() : variable.lower;
    chain.upper_[i] = free ? std::numeric_limits<double>::infinity() : variable.upper;
    chain.rotates_[i] = variable.kind != JointKind::prismatic;
  }
  if (!is_pose(X_LT)) return fail("the tip's pose is not finite or not a rotation");
  chain.variables_ = std::move(variables);
  chain.set_tip(X_LT);
  return chain;
}

void Chain::set_tip(const Pose& X_LT) {
  X_LT_ = X_LT;
  forward_constants_ =
      kinematics::forward_constants(joints_.data(), joint_count_, variable_count_, plain_, X_LT.matrix().data());
}

JointValues Chain::middle() const CELL_RT {
  JointValues q{};
  for (std::size_t i = 0; i < variable_count_; ++i) {
    q[i] = std::isfinite(lower_[i]) ? 0.5 * (lower_[i] + upper_[i]) : 0.0;
  }
  return q;
}

bool Chain::within_limits(std::span<const double> q, double slack) const CELL_RT {
  for (std::size_t i = 0; i < variable_count_; ++i) {
    if (!(q[i] >= lower_[i] - slack && q[i] <= upper_[i] + slack)) return false;
  }
  return true;
}

Chain Chain::with_tip(const Pose& X_LT) const {
  Chain chain = *this;
  chain.set_tip(X_LT);
  return chain;
}

Result<Chain> Chain::with_limits(std::span<const double> lower, std::span<const double> upper) const {
  std::vector<Variable> variables = variables_;
  for (std::size_t i = 0; i < variable_count_; ++i) {
    if (variables[i].kind == JointKind::continuous) continue;
    variables[i].lower = lower[i];
    variables[i].upper = upper[i];
  }
  return make(std::move(variables), joints(), X_LT_);
}

}  // namespace cellmirror::kinematics
