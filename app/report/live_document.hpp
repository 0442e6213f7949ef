// What the monitor page shows several times a second (docs/monitor-page.md, `live`).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/report/problem.hpp"
#include "app/snapshot/alarm_report.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/proximity_board.hpp"
#include "app/snapshot/range_readings.hpp"
#include "app/snapshot/tissue_report.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/force_state.hpp"
#include "rt_core/ports/playback.hpp"
#include "rt_core/ports/renderer_counters.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/rt/cyclic_thread.hpp"

namespace cellmirror::app {

// What each output counts, by its name.
using OutputCounters = std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::uint64_t>>>>;

// As of one moment.
struct LiveSources {
  std::string instance;
  std::string cell;
  double uptime_s = 0;
  double rate_hz = 0;
  Timestamp now;
  const CyclicThread& loop;
  const CellState& cell_state;
  const engine::TickState& tick;
  std::span<const RobotState> robots;  // of the same tick
  const CellPoses& poses;              // of the same tick
  std::uint64_t picture_updates = 0;
  std::shared_ptr<const ProximityState> proximity;
  std::shared_ptr<const RangeReadings> ranges;
  std::shared_ptr<const ForceState> forces;
  std::span<const engine::QueueStatus> queues;
  std::span<const Problem> problems = {};
  std::uint64_t commands_logged = 0;                     // changes with the log of commands
  std::shared_ptr<const TissueReport> tissue = nullptr;  // null: no deformable objects
  RendererCounters renderer = {};                        // of the newest picture
  AlarmCounts alarms = {};
  std::optional<PlaybackState> playback = {};    // of a recording; none: real robots
  std::function<OutputCounters()> outputs = {};  // empty: there are none
};

// Percentiles of the loop since the last time this was asked, so that a chart shows what is going on now. One thread at
// a time.
class LoopWindow {
 public:
  struct Figures {
    double latency_p99_us = 0;
    double compute_p99_us = 0;
  };
  [[nodiscard]] Figures look(const CyclicThread& loop);

 private:
  HistogramSnapshot latency_;
  HistogramSnapshot compute_;
};

// Counts changes of what the tree of names looks like, which are fewer than those of the cell. Any thread.
class TreeRevision {
 public:
  [[nodiscard]] std::uint64_t of(const std::shared_ptr<const CompiledCell>& cell);

 private:
  std::mutex mutex_;
  std::shared_ptr<const CompiledCell> last_;
  std::uint64_t revision_ = 0;
};

[[nodiscard]] std::string live_document(const LiveSources& sources, LoopWindow& window, std::uint64_t tree_revision);

}  // namespace cellmirror::app
