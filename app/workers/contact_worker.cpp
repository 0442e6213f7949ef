#include "app/workers/contact_worker.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kLongestRest{4'000'000};

// For which posture it was found: who moves another instrument sees that it is not for it.
void set_posture(const engine::RobotTickState& robot, haptics::ContactModel& found) {
  found.joint_count = robot.joint_count;
  for (std::size_t i = 0; i < robot.joint_count; ++i) found.q[i] = robot.joints[i].position;
}

}  // namespace

ContactWorker::ContactWorker(engine::Engine& engine, engine::TickReader& ticks, const Board<CellState>& cell_states,
                             const Clock& clock, Nanoseconds tick_period,
                             std::shared_ptr<geometry::SolidLibrary> solids)
    : engine_(engine),
      clock_(clock),
      derivation_(std::move(solids)),
      worker_(*this, ticks, cell_states, clock, tick_period) {}

bool ContactWorker::wanted(const CellState& cell_state) {
  const bool wanted = std::ranges::any_of(cell_state.haptics, &HapticSnapshot::online);
  if (!wanted) ages_.paused();
  return wanted;
}

ContactWorker::Finder& ContactWorker::finder_for(const HapticSnapshot& haptic) {
  Finder& out = finders_[haptic.channel];
  if (out.finder && out.slot == haptic.slot && out.reach_m == haptic.reach_m) return out;
  out.slot = haptic.slot;
  out.reach_m = haptic.reach_m;
  out.finder =
      std::make_unique<contact_model::ContactFinder>(haptic.slot, contact_model::FinderSettings{haptic.reach_m});
  out.finder->adopt(follower_.cell(), pairs_);
  return out;
}

bool ContactWorker::follow(const CellState& cell_state) {
  const std::shared_ptr<const CompiledCell> before = follower_.cell();
  const bool news = follower_.take_cell(cell_state.cell);
  const bool other_settings = settings_ != cell_state.collision || ranges_news_;
  if (!news && !other_settings) return false;
  const Timestamp start = clock_.now();
  settings_ = cell_state.collision;
  // A new tool centre point leaves the pairs as they are, and the other instruments are not to wait for it.
  const bool other_bodies = !before || !same_bodies(*before, *follower_.cell(), false);
  if (other_bodies) ranges_.clear();
  ranges_news_ = false;
  if (other_settings || other_bodies) pairs_ = derivation_.derive(*follower_.cell(), *settings_, ranges_.beyond());
  for (Finder& finder : finders_) {
    if (finder.finder) finder.finder->adopt(follower_.cell(), pairs_);
  }
  ++cells_;
  adopting_.record(clock_.now() - start);
  return true;
}

void ContactWorker::run(const CellState& cell_state, const engine::TickState& tick) {
  // After a long derivation the posture is old, and a component that was just loaded reaches the tick a moment later.
  if (follow(cell_state) || !follower_.take_posture(tick)) return;
  if (ranges_.note(*follower_.cell(), follower_.positions())) {
    ranges_news_ = true;
    (void)follow(cell_state);  // fast: no proof is attempted for these robots
  }
  const Timestamp start = clock_.now();
  for (const HapticSnapshot& haptic : cell_state.haptics) {
    if (!haptic.online || tick.haptics[haptic.channel].phase == HapticPhase::closed) continue;
    Finder& finder = finder_for(haptic);
    finder.finder->find(follower_.poses(), tick.time, finder.found);
    finder.found.cell = cells_;
    set_posture(tick.robots[haptic.slot], finder.found);
    Latest<haptics::ContactModel>& inlet = engine_.contact_inlet(haptic.channel);
    inlet.writable() = finder.found;
    inlet.publish();
    ages_.shown(tick.time, clock_.now());
    const std::scoped_lock lock(mutex_);
    newest_[haptic.channel] = finder.found;
  }
  const Nanoseconds taken = clock_.now() - start;
  compute_.record(taken);
  // At most half of a processor: planes are good for some millimetres of way, and the rest of the gateway is to fit
  // beside this on one core.
  std::this_thread::sleep_for(std::min(taken, kLongestRest));
}

ContactReport ContactWorker::report() const {
  ContactReport out;
  out.skipped = worker_.skipped();
  out.rate_hz = worker_.rate_hz();
  out.compute = compute_.snapshot();
  out.visible_after = ages_.visible_after().snapshot();
  out.adopting = adopting_.snapshot();
  const std::scoped_lock lock(mutex_);
  out.newest = newest_;
  return out;
}

}  // namespace cellmirror::app
