// Brings components into the tree. Planning finds everything that may be wrong and changes nothing; committing a plan
// cannot fail. Private to this folder.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/cell_state.hpp"

namespace cellmirror {

// A component to attach below a node, with those loaded by its own nodes.
struct PendingComponent {
  std::shared_ptr<const Component> component;
  const AbstractReference* reference = nullptr;                                   // null: the cell file itself
  std::vector<std::pair<std::size_t, std::unique_ptr<PendingComponent>>> nested;  // by node of the component
};

class CellBuilder {
 public:
  CellBuilder(Cell::State& state, Diagnostics& diagnostics);

  // The component of the ABSTRACT file of `node`; nothing, with diagnostics, if it cannot be loaded.
  std::unique_ptr<PendingComponent> plan(NodeId node);
  // The cell file. Errors do not stop it, so that all are found.
  std::unique_ptr<PendingComponent> plan_root();
  // After errors the nodes are still created, to find more, but no robots.
  void commit(NodeId at, const PendingComponent& pending);
  // The `predecessor` keys of the cell file, once everything is there.
  void connect_predecessors();

 private:
  std::unique_ptr<PendingComponent> plan_file(const AbstractReference& reference, const Place& place);
  std::unique_ptr<PendingComponent> plan_component(const std::shared_ptr<const Component>& component,
                                                   const AbstractReference* reference, const Place& place);
  void check_names_below(const Component& component, std::size_t node, const Component& below);
  void plan_robot(const Component& component, const AbstractReference* reference, const Place& place);
  NodeId add_node(NodeId parent, const std::shared_ptr<const Component>& component, const ComponentNode& definition);
  void add_robot(NodeId at, const PendingComponent& pending, const std::vector<NodeId>& ids);
  [[nodiscard]] bool lies_in_gap(std::string_view path) const;
  std::size_t take_slot(const std::string& id);

  Cell::State& state_;
  Diagnostics& diagnostics_;
  std::vector<std::string> files_above_;  // to notice that a component would contain itself
  std::vector<std::string> robots_planned_;
  std::size_t nodes_planned_ = 0;
  bool incomplete_ = false;  // some component is not part of the plan
};

}  // namespace cellmirror
