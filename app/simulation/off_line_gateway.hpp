// The gateway without threads, queues and real time: the same owner and the same tick, taking turns by a clock that
// only goes on when a tick has passed. One thread.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/owner/cell_owner.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/tissue_port.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/watchdog.hpp"
#include "scripts/programs/controller/program_status.hpp"

namespace cellmirror::app {

// Who looks on. Each call is within begin(), work() or tick(), on the one thread.
struct OffLineObserver {
  std::function<void(const std::shared_ptr<const CellState>& cell_state, const engine::TickState& tick)> tick;
  std::function<void(std::string_view robot, const motion::Move& move)> move;  // that the tick is given
  std::function<void(const Diagnostics& findings)> refused;                    // a command of a SCRIPT file
  std::function<void(const program::ProgramEvent& event)> program;
  std::function<void(const ShownText& message)> message;
};

class OffLineGateway {
 public:
  // Instants begin here, so that none of them is "never".
  static constexpr Timestamp kBegin{1'000'000'000};

  // `tissue` may be null; else it outlives this.
  OffLineGateway(LoadedCell cell, OffLineObserver observer, TissuePort* tissue = nullptr);

  // Begins the script (CellOwner::prepare()).
  Result<void> begin(const std::string& script, bool is_path);
  // Everything that the owner can do at this instant. An endless loop of a program does not keep it: so many turns of
  // the owner are about what it has within a tick of the gateway. True where anything was done.
  bool work();
  // One period on.
  void tick();

  [[nodiscard]] const CellOwner& owner() const { return *owner_; }
  [[nodiscard]] const CellState& cell_state() const { return *board_.latest(); }
  [[nodiscard]] double time_s() const { return seconds(clock_.now() - kBegin); }
  [[nodiscard]] Nanoseconds period() const { return period_; }
  [[nodiscard]] std::uint64_t ticks() const { return context_.cycle; }
  [[nodiscard]] bool robots_move() const { return robots_move_; }

 private:
  static constexpr int kTurnsPerTick = 8;

  OffLineObserver observer_;
  ManualClock clock_;
  Watchdog watchdog_;
  engine::Engine engine_;
  engine::TickReader& ticks_;
  Board<CellState> board_;
  Nanoseconds period_;
  CycleContext context_;
  bool robots_move_ = false;
  std::unique_ptr<CellOwner> owner_;
};

}  // namespace cellmirror::app
