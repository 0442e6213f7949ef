// Joins the newest model of the cell, the newest tick and what the workers have found into the scene of a picture.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "app/snapshot/board.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/proximity_board.hpp"
#include "app/snapshot/range_readings.hpp"
#include "app/snapshot/tick_poser.hpp"
#include "app/snapshot/trace_state.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/ports/picture_request.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/scene/cameras.hpp"
#include "rt_core/scene/panes.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::app {

// Of the cell at `poses`, as `request` says; also used without a gateway.
[[nodiscard]] Result<std::vector<Pane>> panes_of(const scene::PaneInput& input, const PictureRequest& request);

// One thread, which alone reads `ticks`.
class SceneSource {
 public:
  // Not owned; they outlive the source.
  struct Boards {
    engine::TickReader& ticks;
    const Board<CellState>& pictures;
    const ProximityBoard& proximity;
    const Board<RangeReadings>& ranges;
    const Board<ForceState>& forces;
    const Board<TraceState>& traces;
    const Clock& clock;                                              // by which pictures are made
    std::function<std::shared_ptr<const TissueView>()> tissue = {};  // empty: the cell has none
    const Clock* cell_clock = nullptr;                               // of what they show; null: the same

    [[nodiscard]] Timestamp cell_now() const { return cell_clock != nullptr ? cell_clock->now() : clock.now(); }
  };

  explicit SceneSource(const Boards& boards) : boards_(boards) {}

  // Takes the newest of everything. False, with the scene as it was, where the tick does not know all robots of the
  // cell yet: a component was just loaded.
  bool refresh();
  // As of the last refresh() that was true.
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const CompiledCell& cell() const { return *cell_; }
  [[nodiscard]] bool has_scene() const { return cell_ != nullptr; }
  // Of all cameras, in the order of the cell.
  [[nodiscard]] std::vector<scene::CameraNow> cameras() const {
    return scene::cameras_now(*cell_, poser_.poses(), *picture_->display);
  }
  // What is in force for them there; null: not known.
  [[nodiscard]] const VolumeStates* volumes() const { return picture_ ? picture_->volumes.get() : nullptr; }
  [[nodiscard]] Timestamp refreshed() const { return now_; }
  [[nodiscard]] Result<std::vector<Pane>> panes(const PictureRequest& request, std::uint64_t updates) const;

 private:
  void take_conditions(const engine::TickState& tick, Timestamp now);

  Boards boards_;
  std::shared_ptr<const CellState> picture_;
  std::shared_ptr<const CompiledCell> cell_;
  TickPoser poser_;
  std::vector<scene::RobotCondition> conditions_;
  scene::SceneBuilder builder_;
  Scene scene_;
  Timestamp now_;
  Timestamp cell_now_;  // likewise, by the time of the cell
};

}  // namespace cellmirror::app
