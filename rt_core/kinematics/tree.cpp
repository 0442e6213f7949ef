#include "rt_core/kinematics/tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/base/contract.hpp"
#include "rt_core/kinematics/joint_motion.hpp"

namespace cellmirror::kinematics {

namespace {

constexpr double kUnitSlack = 1e-6;

Result<void> check_joint(const TreeLink& link, std::size_t variables) {
  const TreeJoint& joint = *link.joint;
  if (joint.variable >= variables) return fail(fmt::format("joint {} has no variable", link.name));
  if (!joint.axis.allFinite() || std::abs(joint.axis.norm() - 1.0) > kUnitSlack) {
    return fail(fmt::format("joint {}: its axis has the length {:g} instead of 1", link.name, joint.axis.norm()));
  }
  if (!std::isfinite(joint.multiplier) || !std::isfinite(joint.offset)) {
    return fail(fmt::format("joint {}: its factor or offset is not a finite number", link.name));
  }
  return {};
}

Result<void> check_link(const std::vector<TreeLink>& links, std::size_t i, std::size_t variables) {
  const TreeLink& link = links[i];
  if (link.parent < Tree::kRoot || link.parent >= static_cast<std::int32_t>(i)) {
    return fail(fmt::format("link {} must come after its parent", link.name));
  }
  if (!is_pose(link.X_PL)) return fail(fmt::format("the pose of {} is not finite or not a rotation", link.name));
  return link.joint ? check_joint(link, variables) : Result<void>{};
}

// A rotation whose z axis is `axis`: the identity for z itself, a mere exchange of axes for x, y and their opposites,
// so that nothing is rounded there.
Pose frame_along(const Eigen::Vector3d& axis) {
  Eigen::Index across = 0;
  axis.cwiseAbs().minCoeff(&across);
  const Eigen::Vector3d z = axis.normalized();
  const Eigen::Vector3d x = (Eigen::Vector3d::Unit(across) - z[across] * z).normalized();
  Pose X = Pose::Identity();
  X.linear() << x, z.cross(x), z;
  return X;
}

// Collects the joints on the way from base to tip; what is fixed between them is merged.
class ChainPath {
 public:
  explicit ChainPath(const Tree& tree) : tree_(tree) {}

  // From a link to its parent.
  void climb(std::int32_t link) {
    const TreeLink& at = tree_.links()[static_cast<std::size_t>(link)];
    if (at.joint) add(*at.joint, -at.joint->axis);
    X_ = X_ * at.X_PL.inverse();
  }
  // From its parent to a link.
  void descend(std::int32_t link) {
    const TreeLink& at = tree_.links()[static_cast<std::size_t>(link)];
    X_ = X_ * at.X_PL;
    if (at.joint) add(*at.joint, at.joint->axis);
  }

  Result<TreeChain> finish(VariableOrder order) {
    number_variables(order);
    std::vector<Variable> variables;
    for (const std::uint8_t variable : used_) variables.push_back(tree_.variables()[variable]);
    auto chain = Chain::make(std::move(variables), joints_, X_);
    if (!chain) return std::unexpected(std::move(chain.error()));
    return TreeChain{std::move(*chain), used_};
  }

 private:
  // A motion against its sense is the motion about the opposite axis.
  void add(const TreeJoint& joint, const Eigen::Vector3d& axis) {
    const Pose X_LJ = frame_along(axis);
    joints_.push_back({X_ * X_LJ, joint.kind, joint.variable, joint.multiplier, joint.offset});
    X_ = X_LJ.inverse();
    if (std::ranges::find(used_, joint.variable) == used_.end()) used_.push_back(joint.variable);
  }

  void number_variables(VariableOrder order) {
    if (order == VariableOrder::of_tree) std::ranges::sort(used_);
    for (ChainJoint& joint : joints_) {
      joint.variable = static_cast<std::uint8_t>(std::ranges::find(used_, joint.variable) - used_.begin());
    }
  }

  const Tree& tree_;
  Pose X_ = Pose::Identity();  // from the last joint (first: the base) to where the path has come
  std::vector<ChainJoint> joints_;
  std::vector<std::uint8_t> used_;  // variables of the tree
};

}  // namespace

Result<Tree> Tree::make(std::vector<Variable> variables, std::vector<TreeLink> links) {
  if (links.size() > kMaxTreeLinks || variables.size() > kMaxTreeVariables) {
    return fail(fmt::format("the tree has {} links and {} joints; at most {} and {} are possible", links.size(),
                            variables.size(), kMaxTreeLinks, kMaxTreeVariables));
  }
  for (const Variable& variable : variables) {
    if (auto checked = check_limits(variable); !checked) return std::unexpected(std::move(checked.error()));
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (auto checked = check_link(links, i, variables.size()); !checked) {
      return std::unexpected(std::move(checked.error()));
    }
  }
  Tree tree;
  tree.links_ = std::move(links);
  tree.variables_ = std::move(variables);
  return tree;
}

Result<TreeChain> Tree::chain(std::int32_t base, std::int32_t tip, VariableOrder order) const {
  const auto count = static_cast<std::int32_t>(links_.size());
  CELLMIRROR_EXPECTS(base >= kRoot && base < count && tip >= kRoot && tip < count);
  // Parents come before their children: the one with the larger index is never above the other.
  ChainPath path(*this);
  std::vector<std::int32_t> down;
  for (std::int32_t up = tip; base != up;) {
    if (base > up) {
      path.climb(base);
      base = links_[static_cast<std::size_t>(base)].parent;
    } else {
      down.push_back(up);
      up = links_[static_cast<std::size_t>(up)].parent;
    }
  }
  for (auto link = down.rbegin(); link != down.rend(); ++link) path.descend(*link);
  return path.finish(order);
}

void forward(const Tree& tree, std::span<const double> q, std::span<Pose> X_RL) CELL_RT {
  CELLMIRROR_EXPECTS(X_RL.size() == tree.links().size() && q.size() >= tree.variables().size());
  for (std::size_t i = 0; i < X_RL.size(); ++i) {
    const TreeLink& link = tree.links()[i];
    X_RL[i] = link.parent < 0 ? link.X_PL : X_RL[static_cast<std::size_t>(link.parent)] * link.X_PL;
    if (!link.joint) continue;
    const TreeJoint& joint = *link.joint;
    apply_joint(joint.kind, joint.axis, joint.multiplier * q[joint.variable] + joint.offset, X_RL[i]);
  }
}

void jacobian(const Tree& tree, std::span<const Pose> X_RL, std::size_t link, TreeJacobian& jacobian) CELL_RT {
  CELLMIRROR_EXPECTS(link < X_RL.size() && X_RL.size() == tree.links().size());
  jacobian.setZero(6, static_cast<Eigen::Index>(tree.variables().size()));
  const Eigen::Vector3d p = X_RL[link].translation();
  for (auto at = static_cast<std::int32_t>(link); at >= 0; at = tree.links()[static_cast<std::size_t>(at)].parent) {
    const auto i = static_cast<std::size_t>(at);
    if (!tree.links()[i].joint) continue;
    const TreeJoint& joint = *tree.links()[i].joint;
    auto column = jacobian.col(joint.variable);
    const Eigen::Vector3d axis = joint.multiplier * (X_RL[i].linear() * joint.axis);
    if (joint.kind == JointKind::prismatic) {
      column.head<3>() += axis;
    } else {
      column.head<3>() += axis.cross(p - X_RL[i].translation());
      column.tail<3>() += axis;
    }
  }
}

}  // namespace cellmirror::kinematics
