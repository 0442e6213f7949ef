// What a Cell holds, and the steps that several of its operations share. Private to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/cell/cell.hpp"

namespace cellmirror {

// The order of the compiled arrays: what no joint moves first, and in both parts predecessors before their successors.
// It stays as long as nodes and predecessors stay.
struct PictureOrder {
  std::vector<NodeId> nodes;           // by index
  std::vector<std::int32_t> index_of;  // by NodeId
  std::size_t fixed_count = 0;
  std::shared_ptr<const std::vector<std::string>> paths;  // by index
};

struct Cell::State {
  std::shared_ptr<const Component> root;
  std::shared_ptr<ComponentSource> source;
  std::vector<std::optional<Node>> nodes;  // by NodeId
  std::vector<NodeId> free;                // ids that may be used again
  std::size_t node_count = 0;
  NameIndex names;
  std::array<std::unique_ptr<RobotModel>, kMaxRobots> robots;
  TextMap<std::size_t> slots;               // by robot id; stays when the robot is deleted
  std::size_t robot_capacity = kMaxRobots;  // slots 0 to robot_capacity - 1 may be used
  std::function<bool(std::string_view)> is_online = [](std::string_view) { return false; };
  std::uint64_t revision = 1;
  std::uint64_t structure_revision = 1;  // changes of nodes and predecessors: the order of the compiled arrays

  mutable std::shared_ptr<const CompiledCell> compiled;
  mutable PictureOrder order;
  mutable std::uint64_t order_structure = 0;  // the structure_revision of `order`

  [[nodiscard]] Node& at(NodeId id) {
    std::optional<Node>& node = nodes[static_cast<std::size_t>(id)];
    CELLMIRROR_EXPECTS(node.has_value());
    return *node;
  }
  [[nodiscard]] const Node& at(NodeId id) const { return const_cast<State*>(this)->at(id); }
  [[nodiscard]] Result<NodeId> find(std::string_view path, PathKind kind = PathKind::any) const;
  [[nodiscard]] bool visible(NodeId id) const;

  void changed() { ++revision; }
  void changed_structure() {
    ++revision;
    ++structure_revision;
  }

  // `above` is `node` or an ancestor of it, by predecessors or by names.
  [[nodiscard]] bool is_below(NodeId node, NodeId above) const;
  [[nodiscard]] bool named_within(NodeId node, NodeId above) const;
  // The robot to whose mechanism the node belongs: its base, joints, flange, ZP frame and what lies between; null:
  // none.
  [[nodiscard]] const RobotModel* robot_of_mechanism(NodeId node) const;
  // `node` and everything below it in the tree of names, parents first.
  [[nodiscard]] std::vector<NodeId> branch(NodeId node) const;

  // The geometry of its father, in the file that declares `node`, that may represent it.
  [[nodiscard]] const std::vector<Geometry>& father_geometry(const Node& node) const;
  [[nodiscard]] bool has_father_geometry(const Node& node) const;
  [[nodiscard]] std::shared_ptr<const CompiledCell> make_picture() const;
};

}  // namespace cellmirror
