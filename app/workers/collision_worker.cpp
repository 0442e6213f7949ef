#include "app/workers/collision_worker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/workers/drive_contacts.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

constexpr std::uint64_t kContactPeriod = 16;  // postures from one refreshed contact of a lasting touch to the next
constexpr Nanoseconds kAhead{10'000'000};     // for closing speeds: short beside the time in which a robot brakes

void log_event(const ProximityEvent& event) {
  const std::string& a = event.short_a;
  const std::string& b = event.short_b;
  switch (event.change) {
    case ProximityChange::entered_warning:
      return log_info("collision.near", "{} and {} are within the warning distance: {:.1f} mm", a, b,
                      event.distance_m * 1e3);
    case ProximityChange::touched:
      return log_warning("collision.touch", "{} touches {}", a, b);
    case ProximityChange::parted:
      return log_info("collision.parted", "{} has parted from {}", a, b);
    case ProximityChange::left_warning:
      return log_info("collision.left", "{} and {} have left the warning distance", a, b);
  }
}

}  // namespace

CollisionWorker::CollisionWorker(engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock,
                                 Nanoseconds tick_period, std::shared_ptr<geometry::SolidLibrary> solids)
    : cell_states_(cell_states),
      clock_(clock),
      derivation_(std::move(solids)),
      worker_(*this, ticks, cell_states, clock, tick_period) {}

bool CollisionWorker::wanted(const CellState& cell_state) {
  const bool wanted = cell_state.collision->active &&
                      !(nothing_to_test_ && cell_state.collision == settings_ && !follower_.differs(cell_state.cell));
  if (!wanted) {
    ages_.paused();
    show_nothing(cell_state);
    clear_contacts(cell_state);
  }
  return wanted;
}

// When tests were switched off or the last pair to test went: readers remove what they show. The posture's
// time stays, so that nobody takes it for news that nothing touches.
void CollisionWorker::show_nothing(const CellState& cell_state) {
  const auto last = board_.latest();
  if (!last || last->pairs == 0) return;
  std::shared_ptr<ProximityState> nothing = states_.take();
  *nothing = ProximityState();
  nothing->sequence = ++sequence_;
  nothing->posture_time = last->posture_time;
  nothing->finished = last->finished;
  nothing->names = last->names;
  nothing->short_names = last->short_names;
  nothing->warning_distance_m = cell_state.collision->warning_distance_m;
  board_.publish(std::move(nothing));
}

void CollisionWorker::adopt(const CellState& cell_state) {
  {
    const std::scoped_lock lock(mutex_);
    note_ = "pairs are being derived";
  }
  settings_ = cell_state.collision;
  std::shared_ptr<const collision::PairTable> pairs =
      derivation_.derive(*follower_.cell(), *settings_, ranges_.beyond());
  checker_.adopt(follower_.cell(), pairs, *settings_);
  // Deep overlaps cost some milliseconds each; the rate of results comes first.
  checker_.limit_contacts(1, kContactPeriod);
  nothing_to_test_ =
      std::ranges::none_of(pairs->pairs, [](const collision::Pair& pair) { return is_tested(pair.state); });
  const std::scoped_lock lock(mutex_);
  pairs_ = std::move(pairs);
  note_ = nothing_to_test_ ? "there is no pair to test" : "";
}

void CollisionWorker::run(const CellState& cell_state, const engine::TickState& tick) {
  const bool news = follower_.take_cell(cell_state.cell);
  if (news) ranges_.clear();
  const bool changed = news || settings_ != cell_state.collision;
  if (changed) adopt(cell_state);
  // A component that was just loaded: its robots reach the tick a moment later. After a long derivation the posture is
  // old: the next tick is better.
  if (changed || !follower_.take_posture(tick)) return;
  // Fast: no proof is attempted for the robots that have left their ranges.
  if (ranges_.note(*follower_.cell(), follower_.positions())) adopt(cell_state);
  check(cell_state, tick);
}

void CollisionWorker::check(const CellState& cell_state, const engine::TickState& tick) {
  const Timestamp start = clock_.now();
  const ProximityState& found = checker_.check(follower_.poses(), tick.time, follower_.later(tick, kAhead), kAhead);
  report_contacts(cell_state, *follower_.cell(), follower_.poses(), *pairs_, found);
  const Timestamp finished = clock_.now();
  compute_.record(finished - start);
  std::shared_ptr<ProximityState> state = states_.take();
  *state = found;
  state->finished = finished;
  state->sequence = ++sequence_;  // those that show nothing count, too
  for (const ProximityEvent& event : found.events) log_event(event);
  board_.publish(std::move(state));
  ages_.shown(tick.time, clock_.now());
  const std::scoped_lock lock(mutex_);
  counters_ = checker_.counters();
}

CollisionReport CollisionWorker::report() const {
  CollisionReport report;
  const std::shared_ptr<const CellState> cell_state = cell_states_.latest();
  report.active = cell_state->collision->active;
  report.warning_distance_m = cell_state->collision->warning_distance_m;
  report.state = board_.latest();
  report.events = board_.events_after(0);
  if (report.events.size() > CollisionReport::kEvents)
    report.events.erase(report.events.begin(), report.events.end() - CollisionReport::kEvents);
  report.skipped = worker_.skipped();
  report.rate_hz = worker_.rate_hz();
  report.age = ages_.age().snapshot();
  report.visible_after = ages_.visible_after().snapshot();
  report.compute = compute_.snapshot();
  const std::scoped_lock lock(mutex_);
  report.pairs = pairs_;
  report.counters = counters_;
  report.note = report.active ? note_ : "switched off: SET_COLLPAR active 1 switches it on";
  return report;
}

}  // namespace cellmirror::app
