// Gives what became of deformable objects to the outputs: events with names, once each, and shapes as often as an
// output wants them. Writes a line of the log for each event.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tissue_sources.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/tissue_output.hpp"

namespace cellmirror::app {

// "PUMA_762 puts a clip on cystic_artery of liver at (120.0, 15.5, 830.2) mm": places in the world.
[[nodiscard]] std::string sentence(const NamedTissueEvent& event);

// One thread.
class TissuePublisher {
 public:
  // Does nothing where `sources` is empty.
  TissuePublisher(TissueSources sources, std::size_t outputs);

  // Takes the newest report and logs its new events. `robots`: of the same cell, in the order of the slots.
  void look(const CellState& cell, std::span<const RobotState> robots);
  // What output number `output` has not seen of the newest report. A report holds the last events only: those that
  // passed between two reports are missing, which their numbers show.
  void publish_events(std::size_t output, TissueEventOutput& to);
  // Where that output is due: asks for a view, and gives it on when it is there.
  void publish_shapes(std::size_t output, Timestamp now, TissueShapeOutput& to);

 private:
  struct Reader {
    std::uint64_t last_event = 0;
    Timestamp shapes_due;
    std::uint64_t last_step = 0;  // of the view that was given last
  };

  void name_events(const CellState& cell);
  void find_forces(const CellState& cell, std::span<const RobotState> robots);
  [[nodiscard]] std::span<const NamedTissueEvent> events_after(std::uint64_t number) const;

  TissueSources sources_;
  std::shared_ptr<const TissueReport> report_;
  std::uint64_t newest_event_ = 0;
  std::uint64_t last_logged_ = 0;
  std::vector<NamedTissueEvent> events_;  // of the newest report
  std::vector<TissueForceArrow> forces_;
  std::vector<Reader> readers_;  // one an output
};

}  // namespace cellmirror::app
