// The model of the workcell: the tree of frames, joints and workframes with the detail levels of its components, and
// the robots. Changed by one thread, its owner; all others read the snapshots of compile(). docs/cell-files.md, "Detail
// levels", defines the SCRIPT commands (manual 1.2.1). A refused operation changes nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/cell/component.hpp"
#include "rt_core/cell/names.hpp"
#include "rt_core/cell/node.hpp"
#include "rt_core/cell/robot_model.hpp"

namespace cellmirror {

class Cell {
 public:
  // The cell that `root` (the cell file) describes, with every component that is to be loaded at the start. Nothing,
  // and all errors in `diagnostics`.
  static std::optional<Cell> build(std::shared_ptr<const Component> root, std::shared_ptr<ComponentSource> source,
                                   Diagnostics& diagnostics);
  Cell(Cell&&) noexcept;
  Cell& operator=(Cell&&) noexcept;
  ~Cell();

  // --- Names. Paths are dotted; levels may be skipped where one node only matches.
  // Cached for repeated paths.
  [[nodiscard]] bool knows(std::string_view path, PathKind kind = PathKind::any) const;
  // An error names the candidates of an ambiguous path or the nearest names.
  [[nodiscard]] Result<NodeId> find(std::string_view path, PathKind kind = PathKind::any) const;
  [[nodiscard]] Error explain(std::string_view path, PathKind kind = PathKind::any) const;
  // The full path of a node, for rules about bodies. The name of a cell with geometry of its own means that geometry
  // alone and takes precedence over shortened paths.
  [[nodiscard]] Result<std::string> find_branch(std::string_view path) const;
  [[nodiscard]] std::vector<std::string> paths(PathKind kind) const;  // full paths of all nodes in memory
  [[nodiscard]] std::string path(NodeId node) const;
  [[nodiscard]] const Node& node(NodeId node) const;
  [[nodiscard]] std::size_t node_count() const;

  // World pose at the joint positions q[slot][joint].
  [[nodiscard]] Pose world_pose(NodeId node, std::span<const JointValues> q) const;

  // --- Detail levels.
  Result<void> activate(std::string_view node);
  Result<void> deactivate(std::string_view node);
  Result<void> delete_node(std::string_view node);
  Result<void> swap_node(std::string_view node);
  Result<void> level_down(std::string_view node);
  Result<void> level_up(std::string_view node);
  // In the tree of names, and so drawn and tested for collision, as what it is or within its father's coarse geometry.
  [[nodiscard]] bool visible(NodeId node) const;

  // --- Places.
  // X_PF: the frame's pose in its kinematic predecessor. A joint is refused.
  Result<void> set_placement(std::string_view node, const Pose& X_PF);
  // Attaches `part` to `predecessor`, keeping its world pose at the joint positions q[slot][joint].
  Result<void> connect(std::string_view part, std::string_view predecessor, std::span<const JointValues> q);
  // Attaches `part` to `predecessor` with the pose of the workframe in its own parent.
  Result<void> attach_at_workframe(std::string_view part, std::string_view predecessor, std::string_view workframe);
  Result<void> set_camera(std::string_view camera, double focal_distance_m, double fovy_rad);
  Result<void> set_sensor_active(std::string_view sensor, bool active);
  Result<void> set_sensor_range(std::string_view sensor, double range_m);

  // --- Robots. Pointers are valid until a component is loaded or deleted.
  [[nodiscard]] const RobotModel* robot(std::string_view id) const;  // nullptr: unknown; one hash look-up
  [[nodiscard]] const RobotModel* robot(std::size_t slot) const;
  // For changing its parameters; counts as a change of the cell.
  [[nodiscard]] RobotModel* edit_robot(std::string_view id);
  [[nodiscard]] Error explain_robot(std::string_view id) const;
  [[nodiscard]] std::vector<std::string> robot_ids() const;  // in the order of the slots
  // Start positions of all robots by slot, kMaxRobots entries; zero where there is no robot.
  [[nodiscard]] std::vector<JointValues> start_positions() const;
  // The largest number of robots, including those present; at most kMaxRobots, the default. A component that would
  // exceed it is refused.
  void set_robot_capacity(std::size_t robots);
  // Called before a component with a robot is deleted: true if that robot is on line. Default: none is.
  void set_online_query(std::function<bool(std::string_view robot)> query);

  // --- Pictures. The revision counts changes; compile() gives the same picture as long as it stays.
  [[nodiscard]] std::uint64_t revision() const;
  [[nodiscard]] std::shared_ptr<const CompiledCell> compile() const;

  struct State;  // private to this folder

 private:
  explicit Cell(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cellmirror
