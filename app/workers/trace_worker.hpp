// Records the trace of the active robot's TCP every tick while SET_MODE SMEAR is on, whether anybody looks or not.
#pragma once

#include <cstdint>

#include "app/snapshot/board.hpp"
#include "app/snapshot/tick_poser.hpp"
#include "app/snapshot/trace_state.hpp"
#include "app/workers/tick_worker.hpp"
#include "app/workers/trace_recorder.hpp"
#include "rt_core/engine/tick_reader.hpp"

namespace cellmirror::app {

class TraceWorker final : private TickJob {
 public:
  // All are not owned and outlive the worker.
  TraceWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
              Nanoseconds tick_period);

  // Any thread. A change is there after kPublishEvery.
  [[nodiscard]] const Board<TraceState>& board() const { return board_; }

 private:
  static constexpr Nanoseconds kPublishEvery{10'000'000};

  bool wanted(const CellState& cell_state) override;
  void run(const CellState& cell_state, const engine::TickState& tick) override;
  void publish();

  const Clock& clock_;
  TraceRecorder recorder_;
  TickPoser poser_;
  std::uint64_t smear_ends_ = 0;
  bool changed_ = false;  // since the last publication
  Timestamp published_;
  Board<TraceState> board_;
  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
