#include "rt_core/cell/cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/text.hpp"
#include "rt_core/cell/cell_builder.hpp"
#include "rt_core/cell/cell_state.hpp"

namespace cellmirror {

Result<NodeId> Cell::State::find(std::string_view path, PathKind kind) const {
  const NodeId node = names.find(path, kind);
  if (node == kNoNode) return std::unexpected(names.explain(path, kind));
  return node;
}

bool Cell::State::visible(NodeId id) const {
  for (NodeId up = id; up != kNoNode; up = at(up).parent) {
    if (at(up).shown != Shown::detail) return false;
  }
  return true;
}

bool Cell::State::is_below(NodeId node, NodeId above) const {
  for (NodeId up = node; up != kNoNode; up = at(up).predecessor) {
    if (up == above) return true;
  }
  return false;
}

bool Cell::State::named_within(NodeId node, NodeId above) const {
  for (NodeId up = node; up != kNoNode; up = at(up).parent) {
    if (up == above) return true;
  }
  return false;
}

const RobotModel* Cell::State::robot_of_mechanism(NodeId node) const {
  for (const auto& robot : robots) {
    if (!robot) continue;
    for (const NodeId end : {robot->flange(), robot->zero_point()}) {
      for (NodeId up = end; up != kNoNode && up != robot->component(); up = at(up).predecessor) {
        if (up == node) return robot.get();
        if (up == robot->base()) break;
      }
    }
    if (std::ranges::find(robot->joints(), node, &RobotJoint::node) != robot->joints().end()) return robot.get();
  }
  return nullptr;
}

std::vector<NodeId> Cell::State::branch(NodeId node) const {
  std::vector<NodeId> found{node};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto& children = at(found[i]).children;
    found.insert(found.end(), children.begin(), children.end());
  }
  return found;
}

const std::vector<Geometry>& Cell::State::father_geometry(const Node& node) const {
  const Node& father = at(node.parent);
  return node.declared_in == father.content ? father.content->geometry : father.definition->geometry;
}

bool Cell::State::has_father_geometry(const Node& node) const {
  return std::ranges::any_of(father_geometry(node), [&](const Geometry& geometry) {
    return std::ranges::find(geometry.stands_for, node.name) != geometry.stands_for.end();
  });
}

namespace {

// The world has no file; its node is declared here.
std::shared_ptr<const Component> world() {
  auto component = std::make_shared<Component>();
  component->nodes.emplace_back();
  return component;
}

}  // namespace

std::optional<Cell> Cell::build(std::shared_ptr<const Component> root, std::shared_ptr<ComponentSource> source,
                                Diagnostics& diagnostics) {
  auto state = std::make_unique<State>();
  state->root = std::move(root);
  state->source = std::move(source);
  Node node;
  node.declared_in = world();
  node.definition = &node.declared_in->nodes.front();
  state->nodes.emplace_back(std::move(node));
  state->node_count = 1;
  CellBuilder builder(*state, diagnostics);
  const auto pending = builder.plan_root();
  if (!pending) return std::nullopt;
  // Predecessors are checked even after other errors, so that one pass reports all.
  builder.commit(kRootNode, *pending);
  builder.connect_predecessors();
  if (!diagnostics.ok()) return std::nullopt;
  return Cell(std::move(state));
}

Cell::Cell(std::unique_ptr<State> state) : state_(std::move(state)) {}
Cell::Cell(Cell&&) noexcept = default;
Cell& Cell::operator=(Cell&&) noexcept = default;
Cell::~Cell() = default;

bool Cell::knows(std::string_view path, PathKind kind) const { return state_->names.find(path, kind) != kNoNode; }
Result<NodeId> Cell::find(std::string_view path, PathKind kind) const { return state_->find(path, kind); }
Error Cell::explain(std::string_view path, PathKind kind) const { return state_->names.explain(path, kind); }
Result<std::string> Cell::find_branch(std::string_view path) const {
  const Component& root = *state_->root;
  if (!root.name.empty() && path == root.name && !root.geometry.empty()) return root.name;
  const Result<NodeId> node = state_->find(path);
  if (!node) return std::unexpected(node.error());
  return this->path(*node);
}

std::vector<std::string> Cell::paths(PathKind kind) const { return state_->names.paths(kind); }
std::string Cell::path(NodeId node) const { return state_->names.path(node); }
const Node& Cell::node(NodeId node) const { return state_->at(node); }
std::size_t Cell::node_count() const { return state_->node_count; }
bool Cell::visible(NodeId node) const { return state_->visible(node); }

const RobotModel* Cell::robot(std::string_view id) const {
  const auto slot = state_->slots.find(id);
  return slot == state_->slots.end() ? nullptr : state_->robots[slot->second].get();
}

const RobotModel* Cell::robot(std::size_t slot) const {
  return slot < kMaxRobots ? state_->robots[slot].get() : nullptr;
}

RobotModel* Cell::edit_robot(std::string_view id) {
  const auto slot = state_->slots.find(id);
  if (slot == state_->slots.end() || !state_->robots[slot->second]) return nullptr;
  state_->changed();
  return state_->robots[slot->second].get();
}

Error Cell::explain_robot(std::string_view id) const {
  const std::vector<std::string> ids = robot_ids();
  std::string remedy = did_you_mean(id, ids);
  if (remedy.empty() && !ids.empty()) {
    constexpr std::size_t kNamed = 12;
    remedy = "the robots are ";
    for (std::size_t i = 0; i < std::min(ids.size(), kNamed); ++i) remedy += (i == 0 ? "" : ", ") + ids[i];
    if (ids.size() > kNamed) remedy += ", ...";
  }
  return {fmt::format("there is no robot {}", printable(id)), remedy};
}

std::vector<std::string> Cell::robot_ids() const {
  std::vector<std::string> ids;
  for (const auto& robot : state_->robots) {
    if (robot) ids.push_back(robot->id());
  }
  return ids;
}

std::vector<JointValues> Cell::start_positions() const {
  std::vector<JointValues> positions(kMaxRobots);
  for (const auto& robot : state_->robots) {
    if (robot) positions[robot->slot()] = robot->parameters().start_position;
  }
  return positions;
}

void Cell::set_robot_capacity(std::size_t robots) {
  CELLMIRROR_EXPECTS(robots <= kMaxRobots);
  for (std::size_t slot = robots; slot < kMaxRobots; ++slot) CELLMIRROR_EXPECTS(!state_->robots[slot]);
  state_->robot_capacity = robots;
}

void Cell::set_online_query(std::function<bool(std::string_view)> query) { state_->is_online = std::move(query); }

std::uint64_t Cell::revision() const { return state_->revision; }

std::shared_ptr<const CompiledCell> Cell::compile() const {
  if (!state_->compiled || state_->compiled->revision != state_->revision) state_->compiled = state_->make_picture();
  return state_->compiled;
}

}  // namespace cellmirror
