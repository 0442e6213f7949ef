// The thread that gives robot states, collisions, ranges, cameras and events of tissue to the outputs, each at its
// rate, in step with the tick.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/io/controller_publisher.hpp"
#include "app/io/range_watch.hpp"
#include "app/io/tissue_publisher.hpp"
#include "app/snapshot/board.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/proximity_board.hpp"
#include "app/snapshot/range_readings.hpp"
#include "app/snapshot/robot_states.hpp"
#include "app/snapshot/tissue_sources.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/ports/camera_state.hpp"
#include "rt_core/ports/description_output.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/tissue_output.hpp"

namespace cellmirror::app {

struct PublishedOutput {
  std::unique_ptr<RobotStateOutput> output;
  Nanoseconds period{0};
  FindingsOutput* findings = nullptr;          // the same object; null: it has no use for collisions and ranges
  ForceOutput* forces = nullptr;               // likewise
  CameraOutput* cameras = nullptr;             // likewise
  TissueEventOutput* tissue_events = nullptr;  // likewise
  TissueShapeOutput* tissue_shapes = nullptr;  // likewise
  DescriptionOutput* description = nullptr;    // likewise
};

// Gives what is on the boards to one output. Results that were replaced in the meantime are left out, but none of their
// events; where there is nothing new, the newest pairs are given again without events, so that the output sees them
// grow old. One thread.
class FindingsPublisher {
 public:
  FindingsPublisher(const ProximityBoard& proximity, const Board<RangeReadings>& ranges)
      : proximity_(proximity), ranges_(ranges) {}

  void publish_news(FindingsOutput& output, RangeSendMode mode);

 private:
  const ProximityBoard& proximity_;
  const Board<RangeReadings>& ranges_;
  std::uint64_t newest_proximity_ = 0;  // sequence of what was given last
  std::uint64_t newest_event_ = 0;
  std::uint64_t newest_ranges_ = 0;
  ProximityState outgoing_;
};

// The efforts of robots that are moved by commands are those that were computed: nobody measures them.
void take_efforts(const ForceState& forces, std::span<RobotState> robots);

class Publisher {
 public:
  // All but the outputs are not owned and outlive the publisher, the boards of `tissue` too.
  Publisher(engine::TickReader& ticks, const Board<CellState>& board, const ProximityBoard& proximity,
            const Board<RangeReadings>& ranges, const Board<ForceState>& forces, const Clock& clock,
            Nanoseconds tick_period, std::vector<PublishedOutput> outputs, TissueSources tissue = {});
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  [[nodiscard]] const std::vector<PublishedOutput>& outputs() const { return outputs_; }

 private:
  void loop(const std::stop_token& stop);
  // Puts out what is due by `now`; the earliest next due time.
  Timestamp publish_due(Timestamp now);
  void publish_controllers(Timestamp now, Timestamp& next);
  // Gives the description of the sending robots to the outputs where it is new.
  void publish_description(const CellState& cell_state);
  void select_sending(const CellState& cell_state, std::span<const RobotState> robots);

  engine::TickReader& ticks_;
  const Board<CellState>& board_;
  const Board<ForceState>& forces_;
  const Clock& clock_;
  Nanoseconds tick_period_;
  std::vector<PublishedOutput> outputs_;
  ControllerPublisher controllers_;
  std::vector<FindingsPublisher> findings_;  // one an output
  TissuePublisher tissue_;
  std::vector<Timestamp> due_;
  RobotStateBuilder builder_;
  RangeWatch range_watch_;
  std::vector<RobotState> sending_;
  std::vector<bool> wanted_;
  std::vector<bool> described_robots_;
  std::uint64_t described_revision_ = 0;
  std::string description_;  // that was given last; empty: none yet
  std::jthread thread_;      // last: it uses everything above
};

}  // namespace cellmirror::app
