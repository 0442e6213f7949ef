// How the nodes of a compiled cell can move against each other.
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::collision {

// Proofs cover positions beyond a range by up to this much, because streams are noisy at the stops of joints.
inline constexpr double kRangeTolerance = 0.01;         // rad
inline constexpr double kLinearRangeTolerance = 0.001;  // m

// Range of a joint for sampling and proofs. Always finite: one turn, or 10 m each way, for a joint without limits.
struct SampledRange {
  double lower = 0;  // rad or m
  double upper = 0;
  bool whole = true;  // false: the joint can leave the range, so that nothing can be proved
};
[[nodiscard]] SampledRange sampled_range(const CompiledRobot& robot, std::size_t joint);

using SlotSet = std::bitset<kMaxRobots>;

// Collects the robots that have left their joint ranges; nothing is proved about them. One thread.
class RangeWatch {
 public:
  // `q`: positions by slot. Returns true if a further robot has left its ranges: the pairs must then be derived again.
  bool note(const CompiledCell& cell, std::span<const JointValues> q);
  void clear() { beyond_.reset(); }
  [[nodiscard]] const SlotSet& beyond() const { return beyond_; }

 private:
  SlotSet beyond_;
};

// Joints and fixed poses from a node above to a node below, runs of fixed poses taken together.
struct JointChain {
  struct Link {
    Pose X_PJ = Pose::Identity();  // to the joint at position zero
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    double multiplier = 1.0;
    double offset = 0.0;
    JointKind kind = JointKind::revolute;
    std::uint32_t variable = 0;  // of the RelativeMotion; position = multiplier * value + offset
  };
  std::vector<Link> links;
  Pose X_tail = Pose::Identity();

  [[nodiscard]] Pose end(std::span<const double> values) const;
};

// Everything that determines the relative pose of two nodes. Joints that they have in common cancel and are left out;
// mimics share the variable of their master.
struct RelativeMotion {
  JointChain to_a;  // both from the lowest node above both
  JointChain to_b;
  std::vector<SampledRange> variables;

  [[nodiscard]] Pose X_AB(std::span<const double> values) const;
  // Equal for equal motions, bit by bit, in whichever robot and revision.
  void append_signature(std::string& bytes) const;
};

class Mechanism {
 public:
  // `beyond`: robots that have left their ranges.
  explicit Mechanism(const CompiledCell& cell, const SlotSet& beyond = {});

  // No joint between them.
  [[nodiscard]] bool rigid(std::int32_t a, std::int32_t b) const { return group(a) == group(b); }
  // The one joint between them; -1: none or several.
  [[nodiscard]] std::int32_t single_joint(std::int32_t a, std::int32_t b) const;
  // Index of the robot of which the node is a part: named within its component, and carried by nothing but nodes of
  // it up to there. -1: of none.
  [[nodiscard]] std::int32_t link_of(std::int32_t node) const { return link_of_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] RelativeMotion between(std::int32_t a, std::int32_t b) const;

 private:
  [[nodiscard]] std::int32_t group(std::int32_t node) const { return group_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] std::int32_t group_above(std::int32_t group) const;
  [[nodiscard]] JointChain chain(std::int32_t above, std::int32_t below, RelativeMotion& motion,
                                 std::vector<std::uint32_t>& keys) const;

  const CompiledCell& cell_;
  SlotSet beyond_;
  std::vector<std::int32_t> group_;  // the joint that carries the node (itself where it is one), 0: the world
  std::vector<std::int32_t> link_of_;
};

}  // namespace cellmirror::collision
