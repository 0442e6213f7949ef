// Trees and chains of kinematics out of components and cells.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/cell/component.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/tree.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror {

// The joints between two nodes of a component, from the base to the tip. The names are those of links of a URDF, or
// paths of nodes of an .mpc file (levels may be skipped where one node only matches). Where a link and a joint share a
// name, the link is meant. The base need not be above the tip. Variables in the order in which they come from base to
// tip; a mimic is driven by the variable of the joint that it mimics, also if that joint is elsewhere. Only the chain
// between the two counts: the rest of the file may have any number of joints. Refused: unknown and ambiguous names
// (with the nearest names), no joint between the two, more joints than the capacities, an axis of length zero, swapped
// limits, numbers that are not finite; each with file and line.
[[nodiscard]] Result<kinematics::Chain> chain_between(const Component& component, std::string_view base,
                                                      std::string_view tip);

// All nodes of a component: link i is node i, the root of the tree the component's. The variables are the joints
// without mimics, in the order of the nodes. Refused as above, with kMaxTreeLinks and kMaxTreeVariables as capacities.
[[nodiscard]] Result<kinematics::Tree> component_tree(const Component& component);

// The joints of a robot that move its tool.
struct RobotChain {
  kinematics::Chain chain;
  // By variable of the chain, ascending: the number of the joint in the robot. Joints that do not move the tip (those
  // of a gripper) are no variables, and for most robots this is 0, 1, 2, ...
  std::vector<std::uint8_t> joint;

  // The chain's variables out of all joints of the robot.
  [[nodiscard]] JointValues variables_of(const JointValues& joints) const;
  // All joints of the robot: the chain's variables, and `others` where the chain has none.
  [[nodiscard]] JointValues joints_of(const JointValues& variables, const JointValues& others) const;
};

enum class ChainTip : std::uint8_t { tool_center_point, flange };

// From the robot's ZP frame to its TCP (point of reference and tool centre point) or flange, with the present values of
// rob_jnt_rng_min and rob_jnt_rng_max as limits. It is valid until the robot's parameters, its mechanism or the nodes
// of the cell change, see Cell::revision(). Refused: an unknown `id`, with the nearest names; no moving joint, or
// another robot's joint between the two.
[[nodiscard]] Result<RobotChain> robot_chain(const Cell& cell, std::string_view id,
                                             ChainTip tip = ChainTip::tool_center_point);

}  // namespace cellmirror
