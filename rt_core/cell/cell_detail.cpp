// The detail levels of components: ACTIVATE, DEACTIVATE, DELETE_NODE, SWAP_NODE, LEVEL_DOWN, LEVEL_UP. The states and
// their transitions are defined in docs/cell-files.md, "Detail levels".
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "rt_core/cell/cell_builder.hpp"
#include "rt_core/cell/cell_state.hpp"

namespace cellmirror {

namespace {

bool in_memory(const Node& node) { return !node.has_abstract() || node.content != nullptr; }

Error first_finding(const Diagnostics& diagnostics) {
  const auto& all = diagnostics.all();
  const auto at = std::ranges::find(all, Severity::error, &Diagnostic::severity);
  CELLMIRROR_EXPECTS(at != all.end());
  const std::string more = diagnostics.errors() > 1 ? fmt::format(" (and {} more)", diagnostics.errors() - 1) : "";
  return {at->message + more, at->remedy};
}

}  // namespace

// Steps on the state that the operations share.
struct DetailLevels {
  Cell::State& state;

  [[nodiscard]] std::string path(NodeId id) const { return state.names.path(id); }

  Result<void> check_above(NodeId id) const {
    for (NodeId up = state.at(id).parent; up != kNoNode; up = state.at(up).parent) {
      if (state.at(up).shown == Shown::detail) continue;
      return fail(fmt::format("{} is within {}, which is not shown in detail", path(id), path(up)),
                  "ACTIVATE " + path(up) + " first");
    }
    return {};
  }

  [[nodiscard]] Result<void> not_in_memory(NodeId id) const {
    return fail(fmt::format("{} is not in memory", path(id)), "ACTIVATE " + path(id) + " loads it");
  }

  // Place, camera and sensor of a part as its father's file has them, so that a later ACTIVATE brings the state of the
  // files. Not back to a predecessor that is gone, or that hangs on the part by now. Refused: something else would move
  // along.
  Result<void> take_back_settings(NodeId id) {
    Node& node = state.at(id);
    const ComponentNode& definition = *node.definition;
    const NodeId first = node.first_predecessor;
    if (first != kNoNode && !state.is_below(first, id)) {
      const bool moves = node.predecessor != first || node.X_PF.matrix() != definition.X_PF.matrix();
      if (moves) {
        if (auto free = check_nothing_attached(id); !free) return free;
        node.predecessor = first;
        node.X_PF = definition.X_PF;
      }
    }
    node.camera = definition.camera;
    node.sensor = definition.sensor;
    return {};
  }

  [[nodiscard]] Result<void> check_nothing_attached(NodeId id) const {
    for (std::size_t i = 1; i < state.nodes.size(); ++i) {
      if (!state.nodes[i] || state.nodes[i]->predecessor != id || state.nodes[i]->parent == id) continue;
      return fail(fmt::format("{} is attached to {}, which would go back to the place of its file",
                              path(static_cast<NodeId>(i)), path(id)),
                  "CONNECT it to another frame first");
    }
    return {};
  }

  // The coarse geometry of a moved part would be at the old place.
  Result<void> check_at_home(NodeId id) const {
    const Node& node = state.at(id);
    if (node.predecessor == node.first_predecessor) return {};
    return fail(fmt::format("{} is attached to {} now and cannot be replaced by the geometry of its father", path(id),
                            path(node.predecessor)),
                "CONNECT it to its original predecessor first");
  }

  // Shows these nodes in detail; loads what is not in memory. All or nothing.
  Result<void> show_in_detail(const std::vector<NodeId>& ids) {
    std::vector<std::pair<NodeId, std::unique_ptr<PendingComponent>>> plans;
    Diagnostics diagnostics;
    CellBuilder builder(state, diagnostics);
    for (const NodeId id : ids) {
      if (in_memory(state.at(id))) continue;
      auto plan = builder.plan(id);
      if (!plan) return std::unexpected(first_finding(diagnostics));
      plans.emplace_back(id, std::move(plan));
    }
    for (const auto& [id, plan] : plans) builder.commit(id, *plan);
    for (const NodeId id : ids) state.at(id).shown = Shown::detail;
    state.changed();
    return {};
  }

  // The nodes with ABSTRACT files from `top` downwards, by layer: how many of them lie on the way there.
  [[nodiscard]] std::vector<std::vector<NodeId>> layers(NodeId top) const {
    std::vector<std::vector<NodeId>> found;
    std::vector<std::pair<NodeId, std::size_t>> open{{top, 0}};
    for (std::size_t i = 0; i < open.size(); ++i) {
      auto [id, layer] = open[i];
      if (state.at(id).has_abstract()) {
        if (found.size() <= layer) found.resize(layer + 1);
        found[layer++].push_back(id);
      }
      for (const NodeId child : state.at(id).children) open.emplace_back(child, layer);
    }
    return found;
  }

  [[nodiscard]] std::vector<bool> marked(const std::vector<NodeId>& ids) const {
    std::vector<bool> marks(state.nodes.size(), false);
    for (const NodeId id : ids) marks[static_cast<std::size_t>(id)] = true;
    return marks;
  }

  Result<void> check_may_go(const std::vector<NodeId>& going, NodeId top) const {
    const std::vector<bool> goes = marked(going);
    for (std::size_t i = 1; i < state.nodes.size(); ++i) {
      if (!state.nodes[i] || goes[i] || !goes[static_cast<std::size_t>(state.nodes[i]->predecessor)]) continue;
      const auto id = static_cast<NodeId>(i);
      return fail(
          fmt::format("{} is attached to {}, which would be deleted", path(id), path(state.nodes[i]->predecessor)),
          "CONNECT it to another frame first");
    }
    for (const auto& robot : state.robots) {
      if (!robot) continue;
      const bool whole = robot->component() == top || goes[static_cast<std::size_t>(robot->component())];
      if (whole && state.is_online(robot->id()))
        return fail(fmt::format("{} is on line", robot->id()), fmt::format("ROBOT {} offline first", robot->id()));
    }
    return {};
  }

  void erase(const std::vector<NodeId>& going) {
    const std::vector<bool> goes = marked(going);
    for (auto& robot : state.robots) {
      if (robot && goes[static_cast<std::size_t>(robot->component())]) robot.reset();
    }
    for (auto& node : state.nodes) {
      if (node && node->first_predecessor != kNoNode && goes[static_cast<std::size_t>(node->first_predecessor)])
        node->first_predecessor = kNoNode;
    }
    for (const NodeId id : going) {
      state.names.remove(id);
      state.nodes[static_cast<std::size_t>(id)].reset();
      state.free.push_back(id);
      --state.node_count;
    }
    state.changed_structure();
  }
};

Result<void> Cell::activate(std::string_view path) {
  DetailLevels levels{*state_};
  const auto id = state_->find(path);
  if (!id) return std::unexpected(id.error());
  const Node& node = state_->at(*id);
  if (!node.has_abstract() && node.shown == Shown::detail) {
    return fail(fmt::format("{} is active and has no ABSTRACT file that could be loaded", levels.path(*id)));
  }
  if (auto above = levels.check_above(*id); !above) return above;
  if (in_memory(node) && node.shown == Shown::detail) return {};
  return levels.show_in_detail({*id});
}

Result<void> Cell::deactivate(std::string_view path) {
  const auto id = state_->find(path);
  if (!id) return std::unexpected(id.error());
  Node& node = state_->at(*id);
  if (!in_memory(node) && node.shown == Shown::hidden) return DetailLevels{*state_}.not_in_memory(*id);
  if (node.shown == Shown::hidden) return {};
  node.shown = Shown::hidden;
  state_->changed();
  return {};
}

Result<void> Cell::delete_node(std::string_view path) {
  DetailLevels levels{*state_};
  const auto id = state_->find(path);
  if (!id) return std::unexpected(id.error());
  Node& node = state_->at(*id);
  if (!in_memory(node)) return levels.not_in_memory(*id);
  std::vector<NodeId> going;
  if (node.has_abstract()) {
    // The node itself and what its father's file declares below it stay, so that ACTIVATE can load it again.
    for (const NodeId child : node.children) {
      if (state_->at(child).declared_in != node.content) continue;
      const std::vector<NodeId> below = state_->branch(child);
      going.insert(going.end(), below.begin(), below.end());
    }
  } else {
    if (const RobotModel* robot = state_->robot_of_mechanism(*id)) {
      return fail(fmt::format("{} is part of the robot {}", levels.path(*id), robot->id()),
                  "DELETE_NODE " + levels.path(robot->component()) + " deletes the whole robot");
    }
    going = state_->branch(*id);
  }
  if (auto may = levels.check_may_go(going, *id); !may) return may;
  if (node.has_abstract()) {
    if (auto back = levels.take_back_settings(*id); !back) return back;
    const auto stays = [&](NodeId child) { return state_->at(child).declared_in != node.content; };
    std::erase_if(node.children, [&](NodeId child) { return !stays(child); });
    for (auto& robot : state_->robots) {
      if (robot && robot->component() == *id) robot.reset();
    }
    node.content.reset();
    if (node.shown == Shown::detail) node.shown = Shown::hidden;
  } else {
    std::erase(state_->at(node.parent).children, *id);
  }
  levels.erase(going);
  return {};
}

Result<void> Cell::swap_node(std::string_view path) {
  DetailLevels levels{*state_};
  const auto id = state_->find(path);
  if (!id) return std::unexpected(id.error());
  Node& node = state_->at(*id);
  if (!node.has_abstract()) return fail(fmt::format("{} has no ABSTRACT file with details", levels.path(*id)));
  if (!state_->has_father_geometry(node)) {
    return fail(fmt::format("{} has no father geometry: {} has no stands_for geometry for it", levels.path(*id),
                            node.declared_in->file),
                "give a geometry of its father stands_for = [\"" + node.name + "\"]");
  }
  if (auto above = levels.check_above(*id); !above) return above;
  if (node.shown != Shown::detail) return levels.show_in_detail({*id});
  if (auto home = levels.check_at_home(*id); !home) return home;
  node.shown = Shown::coarse;
  state_->changed();
  return {};
}

Result<void> Cell::level_down(std::string_view path) {
  DetailLevels levels{*state_};
  const auto id = state_->find(path);
  if (!id) return std::unexpected(id.error());
  const auto layers = levels.layers(*id);
  if (layers.empty()) return fail(fmt::format("{} has no ABSTRACT files below it", levels.path(*id)));
  if (auto above = levels.check_above(*id); !above) return above;
  if (layers.front().front() != *id && state_->at(*id).shown != Shown::detail)
    return fail(fmt::format("{} is not shown in detail", levels.path(*id)), "ACTIVATE " + levels.path(*id) + " first");
  for (const auto& layer : layers) {
    std::vector<NodeId> next;
    std::ranges::copy_if(layer, std::back_inserter(next),
                         [&](NodeId node) { return state_->at(node).shown != Shown::detail; });
    if (!next.empty()) return levels.show_in_detail(next);
  }
  return fail(fmt::format("{} is shown in full detail already", levels.path(*id)));
}

Result<void> Cell::level_up(std::string_view path) {
  DetailLevels levels{*state_};
  const auto id = state_->find(path);
  if (!id) return std::unexpected(id.error());
  const auto layers = levels.layers(*id);
  if (layers.empty()) return fail(fmt::format("{} has no ABSTRACT files below it", levels.path(*id)));
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    std::vector<NodeId> shown;
    std::ranges::copy_if(*layer, std::back_inserter(shown),
                         [&](NodeId node) { return state_->at(node).shown == Shown::detail; });
    if (shown.empty()) continue;
    for (const NodeId node : shown) {
      if (auto home = levels.check_at_home(node); !home) return home;
      if (node == *id && !state_->has_father_geometry(state_->at(node)))
        return fail(fmt::format("{} has no father geometry that could replace it", levels.path(node)),
                    "DEACTIVATE " + levels.path(node) + " hides it");
    }
    for (const NodeId node : shown) {
      Node& up = state_->at(node);
      up.shown = state_->has_father_geometry(up) ? Shown::coarse : Shown::hidden;
    }
    state_->changed();
    return {};
  }
  return fail(fmt::format("no details of {} are shown", levels.path(*id)), "LEVEL_DOWN shows them");
}

}  // namespace cellmirror
