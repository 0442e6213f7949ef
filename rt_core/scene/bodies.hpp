// The bodies of the cell as they are drawn. What follows from the cell and the draw rules is made when one of them
// changes; a picture costs the poses of what can move.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/bounds.hpp"

namespace cellmirror::scene {

class Bodies {
 public:
  // True where anything but the posture changed.
  bool update(const CompiledCell& cell, const CellPoses& poses, std::span<const DrawRule> rules);
  // Writes all bodies, unmarked.
  void place(const CellPoses& poses, std::vector<SceneBody>& bodies);

  [[nodiscard]] std::size_t count() const { return bodies_.size(); }
  // By body; those of a node follow each other.
  [[nodiscard]] std::int32_t node(std::size_t body) const { return nodes_[body]; }
  [[nodiscard]] const Box& bounds(std::size_t body) const { return boxes_[body]; }

  // Of all that was drawn since update() was true: what moves only widens it.
  [[nodiscard]] const Box& reach() const { return reach_; }
  // Below all static bodies, and not above the world's floor unless the whole cell is far above it.
  [[nodiscard]] double floor_z() const { return floor_z_; }
  // Static, level and lowest slabs: they catch shadows and cast none.
  [[nodiscard]] const std::vector<ShadowCatcher>& slabs() const { return slabs_; }

 private:
  struct Version {
    const CompiledCell* cell = nullptr;
    std::uint64_t revision = 0;
    std::vector<DrawRule> rules;
  };
  [[nodiscard]] bool same(const CompiledCell& cell, std::span<const DrawRule> rules) const;
  void find_floor();
  void find_slabs();
  // What lies flat on a slab would darken itself.
  void leave_paint_without_shadow();

  Version version_;
  std::vector<SceneBody> bodies_;  // in the order of the nodes: static ones first
  std::vector<std::int32_t> nodes_;
  std::vector<Pose> X_NG_;
  std::vector<Box> boxes_;
  std::size_t first_moving_ = 0;
  Box fixed_;
  Box reach_;
  double floor_z_ = 0;
  std::vector<ShadowCatcher> slabs_;
  BoundsOfGeometry bounds_;
};

}  // namespace cellmirror::scene
