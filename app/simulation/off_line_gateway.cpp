#include "app/simulation/off_line_gateway.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/owner/tissue/tissue_parts.hpp"

namespace cellmirror::app {

namespace {

constexpr std::chrono::milliseconds kNeverWatched{100};

bool any_moves(const engine::TickState& tick, const CellState& cell_state) {
  return std::ranges::any_of(cell_state.robots, [&](const RobotSnapshot& robot) {
    const engine::RobotTickState& state = tick.robots[robot.slot];
    return state.motion.moving || state.follow.follows();
  });
}

}  // namespace

OffLineGateway::OffLineGateway(LoadedCell cell, OffLineObserver observer, TissuePort* tissue)
    : observer_(std::move(observer)),
      watchdog_(kNeverWatched, {}),
      engine_(watchdog_, engine::capacity_for(cell.cell.robot_ids().size())),
      ticks_(engine_.subscribe("observer")),
      period_(std::llround(1e9 / cell.loop.rate_hz)) {
  clock_.set(kBegin);
  context_.period = period_;
  owner_ = std::make_unique<CellOwner>(CellOwner::Parts{
      .cell = std::move(cell.cell),
      .home = cell.home,
      .streams = {},
      .haptics = {},
      .views = std::move(cell.views),
      .layout = std::move(cell.layout),
      .collision = std::move(cell.collision),
      .tissue = tissue_parts(cell.tissue, cell.home, tissue),
      .foot_switches = {},
      .engine = engine_,
      .board = board_,
      .clock = clock_,
      .instance = {},
      .save_flight_record = [](std::string_view) -> Result<void> {
        return fail("off line there is no flight recorder");
      },
      .let_tick_pass = [this] { tick(); },
      .refused = [this](const Diagnostics& findings) { observer_.refused(findings); },
      .move_given = [this](std::string_view robot, const motion::Move& move) { observer_.move(robot, move); },
      .program_event = [this](const program::ProgramEvent& event) { observer_.program(event); },
      .message_shown = [this](const ShownText& message) { observer_.message(message); }});
}

Result<void> OffLineGateway::begin(const std::string& script, bool is_path) {
  if (auto prepared = owner_->prepare(script, is_path); !prepared) return prepared;
  tick();  // the robots come
  return {};
}

bool OffLineGateway::work() {
  bool any = false;
  for (int turn = 0; turn < kTurnsPerTick; ++turn) {
    if (!owner_->turn()) return any;
    any = true;
  }
  return any;
}

void OffLineGateway::tick() {
  clock_.advance(period_);
  context_.now = clock_.now();
  context_.scheduled = context_.now;
  engine_.run(context_);
  ++context_.cycle;
  const std::shared_ptr<const CellState> cell_state = board_.latest();
  if (!cell_state) return;
  const engine::TickState& state = ticks_.newest();
  robots_move_ = any_moves(state, *cell_state);
  observer_.tick(cell_state, state);
}

}  // namespace cellmirror::app
