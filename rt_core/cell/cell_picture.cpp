// The compiled picture of a cell.
#include <algorithm>
#include <utility>
#include <vector>

#include "rt_core/cell/cell_state.hpp"

namespace cellmirror {

namespace {

// Finds the order of the compiled arrays.
class Ordering {
 public:
  explicit Ordering(const Cell::State& state) : state_(state), rank_(state.nodes.size(), kUnknown) {
    for (const NodeId id : state.branch(kRootNode)) {
      if (id != kRootNode) find_rank(id);
    }
    rank_[0] = 0;
  }

  PictureOrder sort() const {
    PictureOrder order;
    order.nodes = state_.branch(kRootNode);
    std::ranges::stable_sort(order.nodes, {}, [&](NodeId id) { return rank_[static_cast<std::size_t>(id)]; });
    order.index_of.assign(state_.nodes.size(), -1);
    for (std::size_t i = 0; i < order.nodes.size(); ++i) {
      const auto node = static_cast<std::size_t>(order.nodes[i]);
      order.index_of[node] = static_cast<std::int32_t>(i);
      if (rank_[node] < kMoving) order.fixed_count = i + 1;
    }
    auto paths = std::make_shared<std::vector<std::string>>();
    paths->reserve(order.nodes.size());
    for (const NodeId id : order.nodes) paths->push_back(state_.names.path(id));
    order.paths = std::move(paths);
    return order;
  }

 private:
  static constexpr std::uint32_t kUnknown = 0xFFFF'FFFF;
  static constexpr std::uint32_t kMoving = 0x8000'0000;  // added to the depth below the world

  void find_rank(NodeId id) {
    std::vector<NodeId> chain;
    NodeId up = id;
    for (; up != kRootNode && rank_[static_cast<std::size_t>(up)] == kUnknown; up = state_.at(up).predecessor)
      chain.push_back(up);
    std::uint32_t rank = up == kRootNode ? 0 : rank_[static_cast<std::size_t>(up)];
    for (auto node = chain.rbegin(); node != chain.rend(); ++node) {
      rank += 1;
      if (state_.at(*node).kind() == NodeKind::joint) rank |= kMoving;
      rank_[static_cast<std::size_t>(*node)] = rank;
    }
  }

  const Cell::State& state_;
  std::vector<std::uint32_t> rank_;  // by NodeId
};

class Picture {
 public:
  Picture(const Cell::State& state, const PictureOrder& order) : state_(state), order_(order) {
    cell_->revision = state.revision;
    if (!state.root->name.empty()) cell_->name = state.root->name;
    cell_->paths = order.paths;
    reserve(order.nodes.size());
    cell_->fixed_count = order_.fixed_count;
    for (const NodeId id : order_.nodes) add_node(id);
    for (std::size_t i = 0; i < order_.fixed_count; ++i) {
      const std::int32_t parent = cell_->parent[i];
      cell_->X_WN_fixed.push_back(parent < 0 ? Pose::Identity()
                                             : cell_->X_WN_fixed[static_cast<std::size_t>(parent)] * cell_->X_PF[i]);
    }
    add_robots();
  }

  std::shared_ptr<CompiledCell> finish() { return std::move(cell_); }

 private:
  void reserve(std::size_t nodes) {
    cell_->parent.reserve(nodes);
    cell_->naming_parent.reserve(nodes);
    cell_->X_PF.reserve(nodes);
    cell_->joint_of.reserve(nodes);
    cell_->visible.reserve(nodes);
    cell_->X_WN_fixed.reserve(order_.fixed_count);
  }

  [[nodiscard]] std::int32_t index(NodeId id) const {
    return id == kNoNode ? -1 : order_.index_of[static_cast<std::size_t>(id)];
  }

  void add_node(NodeId id) {
    const Node& node = state_.at(id);
    const auto here = static_cast<std::int32_t>(cell_->parent.size());
    cell_->parent.push_back(index(node.predecessor));
    cell_->naming_parent.push_back(index(node.parent));
    cell_->X_PF.push_back(node.X_PF);
    cell_->visible.push_back(state_.visible(id) ? 1 : 0);
    cell_->joint_of.push_back(-1);
    if (node.kind() == NodeKind::joint) add_joint(node);
    if (node.kind() == NodeKind::camera)
      cell_->cameras.push_back({node.name, here, node.camera.focal_distance_m, node.camera.fovy_rad});
    if (node.kind() == NodeKind::sensor) cell_->sensors.push_back({node.name, here, node.sensor});
    if (node.kind() == NodeKind::workframe) cell_->workframes.push_back(here);
    if (there(id)) {
      add_inertia(here, node.definition->inertia);
      if (node.content) add_inertia(here, node.content->inertia);
    }
    if (node.content && node.content->volume && node.content->volume->grid)
      cell_->volumes.push_back({here, std::shared_ptr<const ComponentVolume>(node.content, &*node.content->volume)});
    if (cell_->visible.back() == 0) return;
    add_geometry(node, here, node.declared_in, node.definition->geometry);
    if (node.content) add_geometry(node, here, node.content, node.content->geometry);
  }

  [[nodiscard]] bool there(NodeId id) const {
    for (NodeId up = id; up != kNoNode; up = state_.at(up).parent) {
      if (state_.at(up).shown == Shown::hidden) return false;
    }
    return true;
  }

  void add_inertia(std::int32_t here, const BodyInertia& inertia) {
    if (inertia.mass_kg != 0.0 || !inertia.I_C.isZero(0.0)) cell_->inertia.push_back({here, inertia});
  }

  void add_joint(const Node& node) {
    cell_->joint_of.back() = static_cast<std::int32_t>(cell_->joints.size());
    const JointDefinition& joint = *node.definition->joint;
    cell_->joints.push_back(
        {joint.axis, node.binding.multiplier, node.binding.offset, joint.kind, node.binding.slot, node.binding.joint});
  }

  // A part represented by the geometry is shown coarsely.
  [[nodiscard]] bool stands_in(const Node& father, const Geometry& geometry) const {
    return std::ranges::any_of(father.children, [&](NodeId id) {
      const Node& child = state_.at(id);
      return child.shown == Shown::coarse &&
             std::ranges::find(geometry.stands_for, child.name) != geometry.stands_for.end();
    });
  }

  void add_geometry(const Node& node, std::int32_t here, const std::shared_ptr<const Component>& owner,
                    const std::vector<Geometry>& list) {
    for (const Geometry& geometry : list) {
      if (!geometry.stands_for.empty() && !stands_in(node, geometry)) continue;
      cell_->geometry.push_back({here, std::shared_ptr<const Geometry>(owner, &geometry)});
    }
  }

  void add_robots() {
    cell_->robot_of_slot.fill(-1);
    for (const auto& robot : state_.robots) {
      if (!robot) continue;
      CompiledRobot compiled;
      compiled.id = robot->id();
      compiled.slot = robot->slot();
      compiled.joint_names = robot->joint_names();
      compiled.joint_kinds.assign(robot->joint_kinds().begin(), robot->joint_kinds().end());
      for (const RobotJoint& joint : robot->joints()) {
        compiled.joint_nodes.push_back(index(joint.node));
        compiled.drives.push_back(joint.drive);
      }
      compiled.min_range = robot->parameters().min_range;
      compiled.max_range = robot->parameters().max_range;
      compiled.start_position = robot->parameters().start_position;
      compiled.component = index(robot->component());
      compiled.base = index(robot->base());
      compiled.zero_point = index(robot->zero_point());
      compiled.flange = index(robot->flange());
      compiled.X_FT = robot->X_FT();
      cell_->robot_of_slot[robot->slot()] = static_cast<std::int16_t>(cell_->robots.size());
      cell_->robots.push_back(std::move(compiled));
    }
  }

  const Cell::State& state_;
  const PictureOrder& order_;
  std::shared_ptr<CompiledCell> cell_ = std::make_shared<CompiledCell>();
};

}  // namespace

std::shared_ptr<const CompiledCell> Cell::State::make_picture() const {
  if (order_structure != structure_revision) {
    order = Ordering(*this).sort();
    order_structure = structure_revision;
  }
  return Picture(*this, order).finish();
}

}  // namespace cellmirror
