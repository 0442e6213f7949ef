#include "rt_core/cell/robot_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "rt_core/base/text.hpp"
#include "rt_core/cell/names.hpp"
#include "rt_core/kinematics/tree.hpp"

namespace cellmirror {

namespace {

using kinematics::Chain;
using kinematics::Tree;
using kinematics::TreeJoint;
using kinematics::TreeLink;
using kinematics::Variable;
using kinematics::VariableOrder;

// --- Of a component.

const ComponentNode& node_at(const Component& component, int index) {
  return component.nodes[static_cast<std::size_t>(index)];
}

std::string place_text(const Component& component, const ComponentNode& node) {
  return fmt::format("{}:{}", component.file, node.line);
}

// The link of that name, else the node of that path.
Result<int> find_node(const Component& component, std::string_view name, std::string_view role) {
  std::vector<int> links;
  std::vector<std::string> known;
  NameIndex names;
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    const ComponentNode& node = component.nodes[i];
    // The index of names reserves 0 for the root, which is no node of the component.
    names.add(static_cast<NodeId>(i + 1), static_cast<NodeId>(node.parent + 1), node.name, node.kind);
    if (node.kind == NodeKind::joint) continue;
    known.push_back(node.name);
    if (node.name == name) links.push_back(static_cast<int>(i));
  }
  if (links.size() == 1) return links.front();
  const NodeId found = names.find(name, PathKind::any);
  if (found != kNoNode) return static_cast<int>(found) - 1;
  const Error why = names.explain(name, PathKind::any);
  const std::string near = links.empty() ? did_you_mean(name, known) : std::string();
  return fail(fmt::format("{}: the {} of the chain: {}", component.file, role, why.what),
              near.empty() ? why.remedy : near);
}

int common_ancestor(const Component& component, int a, int b) {
  // Parents come before their children: the larger of the two is never above the other.
  while (a != b) (a > b ? a : b) = node_at(component, std::max(a, b)).parent;
  return a;
}

Result<int> master_of(const Component& component, int joint) {
  const auto& mimic = node_at(component, joint).joint->mimic;
  if (!mimic) return joint;
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    const ComponentNode& node = component.nodes[i];
    if (node.joint && !node.joint->mimic && node.name == mimic->joint) return static_cast<int>(i);
  }
  const ComponentNode& node = node_at(component, joint);
  return fail(fmt::format("{}: joint {} mimics {}, which is a mimic itself or not a joint", place_text(component, node),
                          node.name, printable(mimic->joint)));
}

// Makes a tree of the nodes between the two ends.
class ComponentTree {
 public:
  explicit ComponentTree(const Component& component) : component_(component) {}

  // The nodes from `node` up to `top` (which is the root of the tree). Gives the link of `node`.
  Result<std::int32_t> add_branch(int node, int top) {
    std::vector<int> branch;
    for (int at = node; at != top; at = node_at(component_, at).parent) branch.push_back(at);
    std::int32_t parent = Tree::kRoot;
    for (auto at = branch.rbegin(); at != branch.rend(); ++at) {
      if (const auto added = add_link(*at, parent); !added) return std::unexpected(added.error());
      parent = static_cast<std::int32_t>(links_.size()) - 1;
    }
    return parent;
  }

  Result<void> add_link(int node, std::int32_t parent) {
    auto link = make_link(node);
    if (!link) return std::unexpected(std::move(link.error()));
    link->parent = parent;
    links_.push_back(std::move(*link));
    return {};
  }

  // Of the joint or of the one that it mimics.
  Result<std::uint8_t> variable_of(int joint) {
    const auto master = master_of(component_, joint);
    if (!master) return std::unexpected(master.error());
    const auto known = std::ranges::find(masters_, *master);
    const auto index = static_cast<std::uint8_t>(known - masters_.begin());
    if (known != masters_.end()) return index;
    if (masters_.size() == kinematics::kMaxTreeVariables) {
      return fail(
          fmt::format("{}: more than {} joints without mimics", component_.file, kinematics::kMaxTreeVariables));
    }
    const ComponentNode& node = node_at(component_, *master);
    Variable variable{node.name, node.joint->kind, node.joint->min_position, node.joint->max_position};
    if (const auto checked = kinematics::check_limits(variable); !checked) {
      return fail(fmt::format("{}: {}", place_text(component_, node), checked.error().what), checked.error().remedy);
    }
    masters_.push_back(*master);
    variables_.push_back(std::move(variable));
    return index;
  }

  Result<Tree> finish() { return Tree::make(std::move(variables_), std::move(links_)); }

 private:
  Result<TreeLink> make_link(int index) {
    const ComponentNode& node = node_at(component_, index);
    TreeLink link{node.name, Tree::kRoot, node.X_PF, std::nullopt};
    if (!kinematics::is_pose(node.X_PF)) {
      return fail(
          fmt::format("{}: the pose of {} is not finite or not a rotation", place_text(component_, node), node.name));
    }
    if (!node.joint) return link;
    const JointDefinition& joint = *node.joint;
    constexpr double kShortest = 1e-6;
    if (!(joint.axis.norm() >= kShortest)) {
      return fail(fmt::format("{}: the axis of joint {} has length zero", place_text(component_, node), node.name),
                  "give it a direction");
    }
    const auto variable = variable_of(index);
    if (!variable) return std::unexpected(variable.error());
    link.joint = TreeJoint{joint.kind, joint.axis.normalized(), *variable, 1.0, 0.0};
    if (joint.mimic) {
      link.joint->multiplier = joint.mimic->multiplier;
      link.joint->offset = joint.mimic->offset;
    }
    return link;
  }

  const Component& component_;
  std::vector<TreeLink> links_;
  std::vector<Variable> variables_;
  std::vector<int> masters_;  // node of the joint, by variable
};

// --- Of a cell.

NodeId common_ancestor(const Cell& cell, NodeId a, NodeId b) {
  std::vector<NodeId> above_a{a};
  while (above_a.back() != kRootNode) above_a.push_back(cell.node(above_a.back()).predecessor);
  while (std::ranges::find(above_a, b) == above_a.end()) b = cell.node(b).predecessor;
  return b;
}

std::vector<Variable> variables_of_robot(const RobotModel& robot) {
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < robot.joint_count(); ++i) {
    variables.push_back({robot.joints()[i].name, robot.joints()[i].kind, robot.parameters().min_range[i],
                         robot.parameters().max_range[i]});
  }
  return variables;
}

// The links from `node` up to `top` (which is the root of the tree) are added. Gives the link of `node`.
Result<std::int32_t> add_branch(const Cell& cell, const RobotModel& robot, NodeId node, NodeId top,
                                std::vector<TreeLink>& links) {
  std::vector<NodeId> branch;
  for (NodeId at = node; at != top; at = cell.node(at).predecessor) branch.push_back(at);
  std::int32_t parent = Tree::kRoot;
  for (auto at = branch.rbegin(); at != branch.rend(); ++at) {
    const Node& here = cell.node(*at);
    TreeLink link{here.name, parent, here.X_PF, std::nullopt};
    if (here.kind() == NodeKind::joint) {
      if (here.binding.slot != robot.slot()) {
        return fail(fmt::format("{} is between the ZP frame and the flange of {}, but belongs to another robot",
                                cell.path(*at), robot.id()),
                    "connect the parts of the robot differently");
      }
      const JointDefinition& joint = *here.definition->joint;
      link.joint = TreeJoint{joint.kind, joint.axis, here.binding.joint, here.binding.multiplier, here.binding.offset};
    }
    parent = static_cast<std::int32_t>(links.size());
    links.push_back(std::move(link));
  }
  return parent;
}

}  // namespace

Result<Chain> chain_between(const Component& component, std::string_view base, std::string_view tip) {
  const auto base_node = find_node(component, base, "base");
  if (!base_node) return std::unexpected(base_node.error());
  const auto tip_node = find_node(component, tip, "tip");
  if (!tip_node) return std::unexpected(tip_node.error());
  const int top = common_ancestor(component, *base_node, *tip_node);
  ComponentTree nodes(component);
  const auto base_link = nodes.add_branch(*base_node, top);
  if (!base_link) return std::unexpected(base_link.error());
  const auto tip_link = nodes.add_branch(*tip_node, top);
  if (!tip_link) return std::unexpected(tip_link.error());
  auto tree = nodes.finish();
  if (!tree) return std::unexpected(std::move(tree.error()));
  if (tree->variables().empty()) {
    return fail(fmt::format("{}: there is no joint between {} and {}", component.file, printable(base), printable(tip)),
                "use two links that move relative to each other");
  }
  auto chain = tree->chain(*base_link, *tip_link, VariableOrder::along_chain);
  if (chain) return std::move(chain->chain);
  return fail(fmt::format("{}: from {} to {}: {}", component.file, printable(base), printable(tip), chain.error().what),
              chain.error().remedy);
}

Result<Tree> component_tree(const Component& component) {
  ComponentTree nodes(component);
  // Masters first, so that the order of the variables does not depend on the position of mimics.
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    const auto& joint = component.nodes[i].joint;
    if (!joint || joint->mimic) continue;
    if (const auto variable = nodes.variable_of(static_cast<int>(i)); !variable) {
      return std::unexpected(variable.error());
    }
  }
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    const auto added = nodes.add_link(static_cast<int>(i), component.nodes[i].parent);
    if (!added) return std::unexpected(added.error());
  }
  return nodes.finish();
}

JointValues RobotChain::variables_of(const JointValues& joints) const {
  JointValues variables{};
  for (std::size_t i = 0; i < joint.size(); ++i) variables[i] = joints[joint[i]];
  return variables;
}

JointValues RobotChain::joints_of(const JointValues& variables, const JointValues& others) const {
  JointValues joints = others;
  for (std::size_t i = 0; i < joint.size(); ++i) joints[joint[i]] = variables[i];
  return joints;
}

Result<RobotChain> robot_chain(const Cell& cell, std::string_view id, ChainTip tip) {
  const RobotModel* robot = cell.robot(id);
  if (robot == nullptr) return std::unexpected(cell.explain_robot(id));
  const NodeId top = common_ancestor(cell, robot->zero_point(), robot->flange());
  std::vector<TreeLink> links;
  const auto base_link = add_branch(cell, *robot, robot->zero_point(), top, links);
  if (!base_link) return std::unexpected(base_link.error());
  const auto tip_link = add_branch(cell, *robot, robot->flange(), top, links);
  if (!tip_link) return std::unexpected(tip_link.error());
  auto tree = Tree::make(variables_of_robot(*robot), std::move(links));
  if (!tree) return std::unexpected(std::move(tree.error()));
  auto made = tree->chain(*base_link, *tip_link, VariableOrder::of_tree);
  if (!made) return fail(fmt::format("robot {}: {}", robot->id(), made.error().what), made.error().remedy);
  RobotChain out{std::move(made->chain), std::move(made->tree_variable)};
  if (tip == ChainTip::tool_center_point) out.chain = out.chain.with_tip(out.chain.X_LT() * robot->X_FT());
  return out;
}

}  // namespace cellmirror
