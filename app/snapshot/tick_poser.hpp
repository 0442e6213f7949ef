// Poses a cell as a tick found its robots. For everything that needs world poses: workers, status, images.
#pragma once

#include <cstddef>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

// Keeps its buffers from call to call. One thread.
class TickPoser {
 public:
  // False, and nothing computed, where the tick does not know all robots of the cell yet: a component was just loaded.
  bool take(const CompiledCell& cell, const engine::TickState& tick);
  // The same, but robots that the tick does not know stand where they stood before, at first at zero.
  void take_known(const CompiledCell& cell, const engine::TickState& tick);

  void reserve(std::size_t nodes) { poses_.reserve(nodes); }

  // As of the last take() that was true, or the last take_known().
  [[nodiscard]] const CellPoses& poses() const { return poses_; }
  // Rad or m, by slot.
  [[nodiscard]] const std::vector<JointValues>& positions() const { return positions_; }

 private:
  std::vector<JointValues> positions_ = std::vector<JointValues>(kMaxRobots);
  CellPoses poses_;
};

}  // namespace cellmirror::app
