#include "app/gateway/collision_worker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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

CollisionWorker::CollisionWorker(engine::Engine& engine, const PictureBoard& pictures, const Clock& clock,
                                 Nanoseconds tick_period, std::shared_ptr<geometry::SolidLibrary> solids)
    : pictures_(pictures),
      clock_(clock),
      derivation_(std::move(solids)),
      worker_(
          "collisions", *this, [&engine]() -> const engine::TickState& { return engine.collision_view(); }, pictures,
          clock, tick_period) {}

bool CollisionWorker::wanted(const OwnerPicture& picture) {
  const bool wanted = picture.collision->active &&
                      !(nothing_to_test_ && picture.collision == settings_ && !follower_.is_news(picture.cell));
  if (!wanted) {
    ages_.paused();
    show_nothing(picture);
  }
  return wanted;
}

// When tests were switched off or the last pair to test went: whoever shows findings takes them away. The posture's
// time stays, so that nobody takes it for news that nothing touches.
void CollisionWorker::show_nothing(const OwnerPicture& picture) {
  const auto last = board_.look();
  if (!last || last->pairs == 0) return;
  std::shared_ptr<ProximityState> nothing = states_.take();
  *nothing = ProximityState();
  nothing->sequence = ++sequence_;
  nothing->posture_time = last->posture_time;
  nothing->finished = last->finished;
  nothing->names = last->names;
  nothing->short_names = last->short_names;
  nothing->warning_distance_m = picture.collision->warning_distance_m;
  board_.hang_up(std::move(nothing));
}

void CollisionWorker::adopt(const OwnerPicture& picture) {
  {
    const std::scoped_lock lock(mutex_);
    note_ = "pairs are being derived";
  }
  settings_ = picture.collision;
  std::shared_ptr<const collision::PairTable> pairs = derivation_.derive(*follower_.cell(), *settings_);
  checker_.adopt(follower_.cell(), pairs, *settings_);
  // Deep overlaps cost some milliseconds each; the rate of results comes first.
  checker_.limit_contacts(1, kContactPeriod);
  nothing_to_test_ =
      std::ranges::none_of(pairs->pairs, [](const collision::Pair& pair) { return is_tested(pair.state); });
  const std::scoped_lock lock(mutex_);
  pairs_ = std::move(pairs);
  note_ = nothing_to_test_ ? "there is no pair to test" : "";
}

void CollisionWorker::run(const OwnerPicture& picture, const engine::TickState& tick) {
  const bool news = follower_.take_cell(picture.cell);
  const bool changed = news || settings_ != picture.collision;
  if (changed) adopt(picture);
  // A component that was just loaded: its robots reach the tick a moment later. After a long derivation the posture is
  // old: the next tick is better.
  if (changed || !follower_.take_posture(tick)) return;
  check(tick);
}

void CollisionWorker::check(const engine::TickState& tick) {
  const Timestamp start = clock_.now();
  const ProximityState& found = checker_.check(follower_.poses(), tick.time, follower_.later(tick, kAhead), kAhead);
  compute_.record(clock_.now() - start);
  std::shared_ptr<ProximityState> state = states_.take();
  *state = found;
  state->sequence = ++sequence_;  // those that show nothing count, too
  for (const ProximityEvent& event : found.events) log_event(event);
  board_.hang_up(std::move(state));
  ages_.shown(tick.time, clock_.now());
  const std::scoped_lock lock(mutex_);
  counters_ = checker_.counters();
}

CollisionReport CollisionWorker::report() const {
  CollisionReport report;
  const std::shared_ptr<const OwnerPicture> picture = pictures_.look();
  report.active = picture->collision->active;
  report.warning_distance_m = picture->collision->warning_distance_m;
  report.state = board_.look();
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
