// Joins the newest model of the cell with the newest tick for a worker that computes with world poses.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "app/snapshot/tick_poser.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

// Whether the two differ in nothing that poses, bodies and the pairs of bodies depend on: cameras, parameters of moves
// and the like may. `sensors`: ultrasonic sensors count too.
[[nodiscard]] bool same_bodies(const CompiledCell& a, const CompiledCell& b, bool sensors);
// Whether the tool centre points of the robots, which are those of both, are where they were. No pose depends on them.
[[nodiscard]] bool same_tool_points(const CompiledCell& a, const CompiledCell& b);

// One thread.
class CellPoser {
 public:
  // Bodies matter always; `sensors`, `tool_points`: these too.
  explicit CellPoser(bool sensors, bool tool_points = false) : sensors_(sensors), tool_points_(tool_points) {}

  // True where the cell is another one than before in what matters here; else the one before is kept, with all that was
  // computed for it.
  bool take_cell(const std::shared_ptr<const CompiledCell>& cell);
  // Whether take_cell() would take it.
  [[nodiscard]] bool differs(const std::shared_ptr<const CompiledCell>& cell) const;
  // Computes the poses at that tick. False, and nothing computed, where the tick does not know all robots of the cell
  // yet: a component was just loaded.
  bool take_posture(const engine::TickState& tick) { return poser_.take(*cell_, tick); }

  // Null before the first take_cell().
  [[nodiscard]] const std::shared_ptr<const CompiledCell>& cell() const { return cell_; }
  // As of the last take_posture() that was true.
  [[nodiscard]] const CellPoses& poses() const { return poser_.poses(); }
  [[nodiscard]] std::span<const JointValues> positions() const { return poser_.positions(); }  // by slot
  // Where everything will be `ahead` later at present velocities, those of mirrored robots only while their data is
  // fresh; null where nothing moves.
  [[nodiscard]] const CellPoses* later(const engine::TickState& tick, Nanoseconds ahead);

 private:
  bool sensors_;
  bool tool_points_;
  std::shared_ptr<const CompiledCell> newest_;  // that was found to be the same as cell_
  std::shared_ptr<const CompiledCell> cell_;
  TickPoser poser_;
  std::vector<JointValues> later_positions_ = std::vector<JointValues>(kMaxRobots);
  CellPoses later_;
};

}  // namespace cellmirror::app
