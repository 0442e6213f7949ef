// A tree of links and the joints between them, for the poses and Jacobians of all links at once; where one tip matters,
// chain() takes the joints between two links out of it. Immutable once made; any number of readers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::kinematics {

inline constexpr std::size_t kMaxTreeLinks = 4096;
inline constexpr std::size_t kMaxTreeVariables = 64;

// Its value is multiplier * q[variable] + offset: rad about or m along the axis.
struct TreeJoint {
  JointKind kind = JointKind::revolute;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit vector in the link's own frame
  std::uint8_t variable = 0;
  double multiplier = 1.0;
  double offset = 0.0;
};

struct TreeLink {
  std::string name;                // for messages
  std::int32_t parent = -1;        // smaller than its own index; -1: the root
  Pose X_PL = Pose::Identity();    // in the parent; where a joint moves it, at the joint's value zero
  std::optional<TreeJoint> joint;  // nothing: fixed to its parent
};

// The order of the variables of a chain.
enum class VariableOrder : std::uint8_t {
  along_chain,  // as they first come from base to tip
  of_tree,      // those of the tree that the chain needs, in the order of the tree
};

struct TreeChain {
  Chain chain;
  std::vector<std::uint8_t> tree_variable;  // by variable of the chain
};

class Tree {
 public:
  static constexpr std::int32_t kRoot = -1;

  // Refused, with the name of the link or joint: more than the capacities, a parent after its child, a joint without
  // its variable, an axis that is not a unit vector, poses or numbers that are not finite or not rotations, swapped
  // limits.
  static Result<Tree> make(std::vector<Variable> variables, std::vector<TreeLink> links);

  [[nodiscard]] std::span<const TreeLink> links() const CELL_RT { return links_; }
  [[nodiscard]] std::span<const Variable> variables() const CELL_RT { return variables_; }

  // The joints between two links (indices, or kRoot). The base need not be above the tip: joints are then traversed in
  // reverse, from child to parent. Refused: no moving joint between the two, and what Chain::make refuses.
  [[nodiscard]] Result<TreeChain> chain(std::int32_t base, std::int32_t tip, VariableOrder order) const;

 private:
  Tree() = default;

  std::vector<TreeLink> links_;
  std::vector<Variable> variables_;
};

// Poses of all links in the root. `q`: one value a variable (rad, m); X_RL: as many as links.
void forward(const Tree& tree, std::span<const double> q, std::span<Pose> X_RL) CELL_RT;

using TreeJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, static_cast<int>(kMaxTreeVariables)>;
// Of a link's origin, expressed in the root, rows as in forward.hpp; resized to 6 x variables. `X_RL`: from forward().
void jacobian(const Tree& tree, std::span<const Pose> X_RL, std::size_t link, TreeJacobian& jacobian) CELL_RT;

}  // namespace cellmirror::kinematics
