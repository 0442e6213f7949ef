#include "app/simulation/collision_watch.hpp"

#include <algorithm>
#include <chrono>
#include <string>

#include "rt_core/geometry/solid.hpp"

namespace cellmirror::app {

namespace {

constexpr std::uint64_t kContactPeriod = 16;    // as the gateway's: a refreshed contact in so many tests
constexpr std::size_t kMostDistances = 20'000;  // of the chart; then every second one is forgotten

void every_second(std::vector<double>& values) {
  for (std::size_t i = 0; 2 * i < values.size(); ++i) values[i] = values[2 * i];
  values.resize((values.size() + 1) / 2);
}

}  // namespace

CollisionWatch::CollisionWatch(Timestamp begin, Nanoseconds period)
    : begin_(begin), period_(period), derivation_(std::make_shared<geometry::SolidLibrary>()) {
  summary_.period_s = seconds(period);
  summary_.why_not = "no tick has passed";
}

void CollisionWatch::adopt(const CellState& cell_state) {
  const bool news = follower_.take_cell(cell_state.cell);
  if (news) ranges_.clear();
  if (!news && settings_ == cell_state.collision) return;
  derive(cell_state);
}

void CollisionWatch::derive(const CellState& cell_state) {
  settings_ = cell_state.collision;
  summary_.warning_distance_m = settings_->warning_distance_m;
  if (!settings_->active) return;
  const auto pairs = derivation_.derive(*follower_.cell(), *settings_, ranges_.beyond());
  checker_.adopt(follower_.cell(), pairs, *settings_);
  checker_.limit_contacts(1, kContactPeriod);
  summary_.pairs = static_cast<std::size_t>(
      std::ranges::count_if(pairs->pairs, [](const collision::Pair& pair) { return is_tested(pair.state); }));
  tested_ = false;
}

bool CollisionWatch::same_posture(const engine::TickState& tick) {
  bool same = tested_;
  for (const CompiledRobot& robot : follower_.cell()->robots) {
    const engine::RobotTickState& state = tick.robots[robot.slot];
    JointValues& before = posture_[robot.slot];
    for (std::size_t i = 0; i < state.joint_count; ++i) {
      same = same && before[i] == state.joints[i].position;
      before[i] = state.joints[i].position;
    }
  }
  return same;
}

void CollisionWatch::observe(const std::shared_ptr<const CellState>& cell_state, const engine::TickState& tick) {
  if (tick.time < next_) return;
  next_ = tick.time + period_;
  const auto begin = std::chrono::steady_clock::now();
  if (cell_state != picture_) {
    picture_ = cell_state;
    adopt(*cell_state);
  }
  if (settings_->active && !same_posture(tick) && follower_.take_posture(tick)) {
    if (ranges_.note(*follower_.cell(), follower_.positions())) derive(*cell_state);
    const ProximityState& found = checker_.check(follower_.poses(), tick.time);
    const double now_s = seconds(tick.time - begin_);
    tested_ = true;
    summary_.tested = true;
    ++summary_.tests;
    take_events(found, now_s);
    take_depths(found, now_s);
    take_distance(found, now_s);
  }
  summary_.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void CollisionWatch::take_events(const ProximityState& found, double now_s) {
  for (const ProximityEvent& event : found.events) {
    if (event.change == ProximityChange::parted) {
      const auto open = touching_.find({event.a, event.b});
      if (open == touching_.end()) continue;
      summary_.collisions[open->second].end_s = now_s;
      touching_.erase(open);
    }
    if (event.change != ProximityChange::touched) continue;
    if (summary_.collisions.size() == kMostKeptCollisions) {
      ++summary_.more_collisions;
      continue;
    }
    touching_[{event.a, event.b}] = summary_.collisions.size();
    SimulatedCollision& collision = summary_.collisions.emplace_back();
    collision.a = event.a;
    collision.b = event.b;
    collision.begin_s = collision.depth_s = now_s;
  }
}

void CollisionWatch::take_depths(const ProximityState& found, double now_s) {
  for (const TouchingPair& pair : found.touching) {
    const auto open = touching_.find({(*found.names)[pair.a], (*found.names)[pair.b]});
    if (open == touching_.end()) continue;
    SimulatedCollision& collision = summary_.collisions[open->second];
    collision.doubtful = collision.doubtful || pair.doubtful;
    if (pair.depth_m <= collision.depth_m) continue;
    collision.depth_m = pair.depth_m;
    collision.depth_s = pair.contact_time.known() ? seconds(pair.contact_time - begin_) : now_s;
  }
}

void CollisionWatch::take_distance(const ProximityState& found, double now_s) {
  const NearPair* nearest = found.nearest();
  if (nearest == nullptr) return;
  if (summary_.distances_m.size() == kMostDistances) {
    every_second(summary_.distances_m);
    every_second(summary_.distance_times_s);
  }
  summary_.distances_m.push_back(nearest->distance_m);
  summary_.distance_times_s.push_back(now_s);
  if (summary_.smallest_distance_m && *summary_.smallest_distance_m <= nearest->distance_m) return;
  summary_.smallest_distance_m = nearest->distance_m;
  summary_.smallest_distance_s = now_s;
  summary_.nearest_a = (*found.names)[nearest->a];
  summary_.nearest_b = (*found.names)[nearest->b];
}

void CollisionWatch::finish(CollisionSummary& summary) {
  if (!summary_.tested && settings_ && !settings_->active)
    summary_.why_not = "switched off by the cell file or SET_COLLPAR";
  if (summary_.tested) summary_.why_not.clear();
  summary_.disagreements = checker_.counters().disagreements;
  summary = std::move(summary_);
}

}  // namespace cellmirror::app
