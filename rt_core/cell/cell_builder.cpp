#include "rt_core/cell/cell_builder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kDeepest = 32;  // components within components

// A node named by a bare name or by a path inside its component; -2: none such.
int node_named(const Component& component, std::string_view name) {
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    if (component.nodes[i].name == name) return static_cast<int>(i);
  }
  return -2;
}

std::vector<std::string> node_names(const Component& component) {
  std::vector<std::string> names;
  for (const ComponentNode& node : component.nodes) names.push_back(node.name);
  return names;
}

}  // namespace

CellBuilder::CellBuilder(Cell::State& state, Diagnostics& diagnostics)
    : state_(state), diagnostics_(diagnostics), nodes_planned_(state.node_count) {
  for (const auto& robot : state_.robots) {
    if (robot) robots_planned_.push_back(robot->id());
  }
}

std::unique_ptr<PendingComponent> CellBuilder::plan(NodeId node) {
  const Node& at = state_.at(node);
  CELLMIRROR_EXPECTS(at.has_abstract());
  files_above_.clear();
  for (NodeId above = at.parent; above != kNoNode; above = state_.at(above).parent) {
    const auto& content = state_.at(above).content;
    if (content) files_above_.push_back(content->file);
  }
  auto pending = plan_file(*at.definition->abstract, at.declared_in->place(*at.definition));
  if (!pending) return nullptr;
  for (const ComponentNode& below : pending->component->nodes) {
    if (below.parent == -1 && state_.names.child(node, below.name) != kNoNode) {
      diagnostics_.error(pending->component->place(below),
                         fmt::format("{} already has a node {}", state_.names.path(node), below.name));
    }
  }
  return diagnostics_.ok() ? std::move(pending) : nullptr;
}

std::unique_ptr<PendingComponent> CellBuilder::plan_root() {
  return plan_component(state_.root, nullptr, {state_.root->file, 0, 0});
}

std::unique_ptr<PendingComponent> CellBuilder::plan_file(const AbstractReference& reference, const Place& place) {
  auto component = state_.source->component_for(reference);
  if (!component) {
    // The loader of the cell file has reported it already when it read the file.
    if (diagnostics_.ok()) diagnostics_.error(place, component.error().what, component.error().remedy);
    return nullptr;
  }
  if (std::ranges::find(files_above_, (*component)->file) != files_above_.end()) {
    diagnostics_.error(place, fmt::format("the component {} would contain itself", reference.file),
                       "remove the reference from one of the files");
    return nullptr;
  }
  if (files_above_.size() >= kDeepest) {
    diagnostics_.error(place, fmt::format("components are nested more than {} deep", kDeepest));
    return nullptr;
  }
  return plan_component(*component, &reference, place);
}

std::unique_ptr<PendingComponent> CellBuilder::plan_component(const std::shared_ptr<const Component>& component,
                                                              const AbstractReference* reference, const Place& place) {
  nodes_planned_ += component->nodes.size();
  if (nodes_planned_ > kMaxNodes) {
    diagnostics_.error(place, fmt::format("the cell would have more than {} nodes", kMaxNodes),
                       "load fewer components at the start");
    return nullptr;
  }
  plan_robot(*component, reference, place);
  auto pending = std::make_unique<PendingComponent>();
  pending->component = component;
  pending->reference = reference;
  files_above_.push_back(component->file);
  for (std::size_t i = 0; i < component->nodes.size(); ++i) {
    const ComponentNode& node = component->nodes[i];
    if (!node.abstract || !node.abstract->loaded) continue;
    if (auto below = plan_file(*node.abstract, component->place(node))) {
      check_names_below(*component, i, *below->component);
      pending->nested.emplace_back(i, std::move(below));
    } else {
      incomplete_ = true;
    }
    if (nodes_planned_ > kMaxNodes) break;
  }
  files_above_.pop_back();
  return pending;
}

void CellBuilder::check_names_below(const Component& component, std::size_t node, const Component& below) {
  for (const ComponentNode& declared : component.nodes) {
    if (declared.parent != static_cast<int>(node)) continue;
    const bool twice = std::ranges::any_of(
        below.nodes, [&](const ComponentNode& other) { return other.parent == -1 && other.name == declared.name; });
    if (twice)
      diagnostics_.error(component.place(declared), fmt::format("{} already has a node {}, from {}",
                                                                component.nodes[node].name, declared.name, below.file));
  }
}

void CellBuilder::plan_robot(const Component& component, const AbstractReference* reference, const Place& place) {
  const bool renamed = reference != nullptr && !reference->robot_id.empty();
  if (!component.robot) {
    if (renamed)
      diagnostics_.error(place,
                         fmt::format("{} has no robot that could be named {}", component.file, reference->robot_id));
    return;
  }
  const std::string& id = renamed ? reference->robot_id : component.robot->id;
  if (reference != nullptr) {
    for (const std::string& name : {reference->robot_base, reference->robot_flange}) {
      if (!name.empty() && node_named(component, name) < 0) {
        diagnostics_.error(place, fmt::format("{} has no node {}", component.file, name),
                           did_you_mean(name, node_names(component)));
      }
    }
  }
  if (std::ranges::find(robots_planned_, id) != robots_planned_.end()) {
    diagnostics_.error(place, fmt::format("there are two robots {}", id),
                       "give one of them another name with robot_id at the node that loads it");
    return;
  }
  if (robots_planned_.size() >= state_.robot_capacity) {
    diagnostics_.error(place, fmt::format("the cell would have more than {} robots", state_.robot_capacity),
                       state_.robot_capacity < kMaxRobots
                           ? fmt::format("a gateway has room for the robots with which its cell begins and {} more: "
                                         "delete a robot first, or load this one at the start",
                                         kSpareRobots)
                           : std::string());
    return;
  }
  robots_planned_.push_back(id);
}

void CellBuilder::commit(NodeId at, const PendingComponent& pending) {
  state_.at(at).content = pending.component;
  std::vector<NodeId> ids;
  ids.reserve(pending.component->nodes.size());
  for (const ComponentNode& definition : pending.component->nodes) {
    const NodeId parent = definition.parent < 0 ? at : ids[static_cast<std::size_t>(definition.parent)];
    ids.push_back(add_node(parent, pending.component, definition));
  }
  if (pending.component->robot && diagnostics_.ok()) add_robot(at, pending, ids);
  for (const auto& [index, nested] : pending.nested) commit(ids[index], *nested);
  state_.changed_structure();
}

NodeId CellBuilder::add_node(NodeId parent, const std::shared_ptr<const Component>& component,
                             const ComponentNode& definition) {
  NodeId id{static_cast<std::uint32_t>(state_.nodes.size())};
  if (state_.free.empty()) {
    state_.nodes.emplace_back();
  } else {
    id = state_.free.back();
    state_.free.pop_back();
  }
  Node node;
  node.name = definition.name;
  node.parent = parent;
  node.predecessor = parent;
  node.first_predecessor = parent;
  node.X_PF = definition.X_PF;
  node.declared_in = component;
  node.definition = &definition;
  node.shown = definition.shown;
  node.camera = definition.camera;
  node.sensor = definition.sensor;
  state_.nodes[static_cast<std::size_t>(id)] = std::move(node);
  ++state_.node_count;
  state_.at(parent).children.push_back(id);
  state_.names.add(id, parent, definition.name, definition.kind);
  return id;
}

std::size_t CellBuilder::take_slot(const std::string& id) {
  if (const auto known = state_.slots.find(id); known != state_.slots.end()) return known->second;
  std::array<bool, kMaxRobots> reserved{};
  for (const auto& [name, slot] : state_.slots) reserved[slot] = true;
  std::size_t slot = static_cast<std::size_t>(std::ranges::find(reserved, false) - reserved.begin());
  if (slot >= state_.robot_capacity) {
    // Every slot was given out once: take that of a robot that is not there any more.
    slot = 0;
    while (state_.robots[slot]) ++slot;
    CELLMIRROR_EXPECTS(slot < state_.robot_capacity);
    std::erase_if(state_.slots, [slot](const auto& entry) { return entry.second == slot; });
  }
  state_.slots.emplace(id, slot);
  return slot;
}

void CellBuilder::add_robot(NodeId at, const PendingComponent& pending, const std::vector<NodeId>& ids) {
  const Component& component = *pending.component;
  const RobotDefinition& definition = *component.robot;
  const auto id_at = [&](int index) { return index < 0 ? at : ids[static_cast<std::size_t>(index)]; };
  const bool renamed = pending.reference != nullptr && !pending.reference->robot_id.empty();
  const std::string& name = renamed ? pending.reference->robot_id : definition.id;
  auto robot = std::make_unique<RobotModel>(name, take_slot(name), definition.parameters);
  robot->component_ = at;
  robot->base_ = id_at(definition.base);
  robot->zero_point_ = id_at(definition.zero_point);
  robot->flange_ = id_at(definition.flange);
  if (pending.reference != nullptr && !pending.reference->robot_base.empty()) {
    robot->base_ = id_at(node_named(component, pending.reference->robot_base));
    robot->zero_point_ = robot->base_;
  }
  if (pending.reference != nullptr && !pending.reference->robot_flange.empty())
    robot->flange_ = id_at(node_named(component, pending.reference->robot_flange));
  CELLMIRROR_EXPECTS(definition.joints.size() <= kMaxJointsPerRobot);
  robot->known_limits_ = definition.limits;
  for (const int index : definition.joints) {
    const ComponentNode& node = component.nodes[static_cast<std::size_t>(index)];
    const auto number = static_cast<std::uint8_t>(robot->joints_.size());
    robot->joints_.push_back({node.name, node.joint->kind, id_at(index), node.joint->drive});
    robot->joint_kinds_.push_back(node.joint->kind);
    state_.at(id_at(index)).binding = {static_cast<std::uint8_t>(robot->slot()), number, 1.0, 0.0};
  }
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    const ComponentNode& node = component.nodes[i];
    if (!node.joint || !node.joint->mimic) continue;
    const auto master = std::ranges::find(robot->joints_, node.joint->mimic->joint, &RobotJoint::name);
    CELLMIRROR_EXPECTS(master != robot->joints_.end());
    state_.at(ids[i]).binding = {static_cast<std::uint8_t>(robot->slot()),
                                 static_cast<std::uint8_t>(master - robot->joints_.begin()),
                                 node.joint->mimic->multiplier, node.joint->mimic->offset};
  }
  const std::size_t slot = robot->slot();
  state_.robots[slot] = std::move(robot);
}

// The path begins at a component that could not be loaded, which was reported.
bool CellBuilder::lies_in_gap(std::string_view path) const {
  if (!incomplete_) return false;
  const NodeId first = state_.names.find(path.substr(0, path.find('.')), PathKind::any);
  if (first == kNoNode) return false;
  return std::ranges::any_of(state_.branch(first), [&](NodeId id) {
    const Node& node = state_.at(id);
    return node.has_abstract() && node.definition->abstract->loaded && !node.content;
  });
}

void CellBuilder::connect_predecessors() {
  for (const NodeId id : std::vector<NodeId>(state_.branch(kRootNode))) {
    Node& node = state_.at(id);
    if (id == kRootNode || node.definition->predecessor.empty()) continue;
    const Place place = node.declared_in->place(*node.definition);
    const auto predecessor = state_.find(node.definition->predecessor);
    if (!predecessor && lies_in_gap(node.definition->predecessor)) continue;
    if (!predecessor) {
      diagnostics_.error(place, predecessor.error().what, predecessor.error().remedy);
      continue;
    }
    if (state_.is_below(*predecessor, id)) {
      diagnostics_.error(place, fmt::format("{} would be its own ancestor: its predecessor {} is below it", node.name,
                                            node.definition->predecessor));
      continue;
    }
    node.predecessor = *predecessor;
    node.first_predecessor = *predecessor;
  }
  state_.changed_structure();
}

}  // namespace cellmirror
