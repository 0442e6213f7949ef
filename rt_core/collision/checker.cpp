#include "rt_core/collision/checker.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "rt_core/base/contract.hpp"
#include "rt_core/collision/proximity_search.hpp"
#include "rt_core/collision/second_opinion.hpp"

namespace cellmirror::collision {

namespace {

constexpr std::size_t kMostDoubts = 100;  // sentences a computation; beyond, they are only counted
constexpr std::size_t kMostDisputes = 4;  // disputed pairs checked again in one computation
constexpr double kLeaveMargin = 0.5e-3;   // m beyond the warning distance
constexpr double kLeastSpeed = 1e-6;      // m/s; slower counts as standing still: no time to contact

enum class Zone : std::uint8_t { far, warning, touching };

// What is remembered about a pair from one computation to the next, for events and doubts.
struct PairHistory {
  Zone zone = Zone::far;
  bool own_touching = false;  // what our narrow phase said last
  bool disputed = false;      // FCL said something else, and has not taken it back
  Timestamp contact_time;     // of the posture for which the reported contact was computed
};

bool touches(const Found& found) {
  return found.usable && found.at.plausible && found.at.distance <= geometry::kTouchDistance;
}

}  // namespace

struct Checker::State {
  std::shared_ptr<const CompiledCell> cell;
  std::shared_ptr<const PairTable> table;
  Settings settings;
  ProximitySearch search;
  ProximitySearch plain_search;  // of collides(), whose postures are others than those of check()
  SecondOpinion second_opinion;
  std::vector<PairHistory> history;   // by tested pair
  std::vector<std::uint8_t> watched;  // by tested pair: not far
  std::uint64_t next_event = 1;
  std::uint64_t round_robin = 0;
  std::size_t disputes_left = 0;
  std::size_t contact_limit = std::numeric_limits<std::size_t>::max();
  std::uint64_t contact_period = 1;
  std::vector<std::uint32_t> stale_contacts;  // pairs in continuing contact that keep their contact points
  ProximityState findings;
  CheckCounters counters;

  void classify(const Found& found, const geometry::Contact* contact, bool its_turn, const CellPoses& poses);
  void ask(const Found& found, const geometry::Contact* contact, PairHistory& pair, const CellPoses& poses);
  void change_zone(const Found& found, PairHistory& pair, Zone zone);
  void add_event(ProximityChange change, const Found& found);
  void add_touching(const Found& found, const geometry::Contact* contact, bool doubtful);
  void add_near(const Found& found, bool doubtful, const CellPoses& poses, const CellPoses* later, Nanoseconds ahead);
  void doubt(std::string text);
  void choose_stale_contacts(const std::vector<Found>& found);
  // Null: they do not touch, or there is no telling.
  const geometry::Contact* contact(const Found& found) {
    if (!touches(found)) return nullptr;
    if (std::ranges::binary_search(stale_contacts, found.pair)) return &search.tracker().last_contact(found.pair);
    history[found.pair].contact_time = findings.posture_time;
    return &search.tracker().contact(found.pair);
  }
  [[nodiscard]] std::string pair_text(const Found& found) const;
  [[nodiscard]] const std::string& name(std::uint32_t body) const { return (*table->names)[body]; }
  [[nodiscard]] const std::string& short_name(std::uint32_t body) const { return (*table->short_names)[body]; }
};

namespace {

const Pose& pose_of(const Body& body, const CellPoses& poses) {
  return poses.X_WN[static_cast<std::size_t>(body.node)];
}

// m/s at which the nearest points of a and b come closer, by where they will be `ahead` later. None where neither
// moves.
std::optional<double> closing_speed(const Body& a, const Body& b, const PairDistance& at, const CellPoses& now,
                                    const CellPoses& later, Nanoseconds ahead) {
  const Pose& X_WA = pose_of(a, now);
  const Pose& X_WB = pose_of(b, now);
  const Pose& X_WA_later = pose_of(a, later);
  const Pose& X_WB_later = pose_of(b, later);
  if (X_WA.matrix() == X_WA_later.matrix() && X_WB.matrix() == X_WB_later.matrix()) return std::nullopt;
  const Eigen::Vector3d step_a = X_WA_later * (X_WA.inverse() * at.p_a) - at.p_a;
  const Eigen::Vector3d step_b = X_WB_later * (X_WB.inverse() * at.p_b) - at.p_b;
  const Eigen::Vector3d towards_b = (at.p_b - at.p_a) / at.distance;
  const double speed = towards_b.dot(step_a - step_b) / seconds(ahead);
  if (!std::isfinite(speed)) return std::nullopt;
  return speed;
}

}  // namespace

// Of the pairs that touched in the posture before as well, all but those whose contacts are the oldest.
void Checker::State::choose_stale_contacts(const std::vector<Found>& found) {
  stale_contacts.clear();
  for (const Found& one : found) {
    if (touches(one) && history[one.pair].own_touching && search.tracker().contact_frame(one.pair) != 0)
      stale_contacts.push_back(one.pair);
  }
  const bool turn = counters.checks % contact_period == 0;
  const std::size_t anew = turn ? std::min(contact_limit, stale_contacts.size()) : 0;
  std::ranges::sort(stale_contacts, {}, [&](std::uint32_t pair) { return search.tracker().contact_frame(pair); });
  stale_contacts.erase(stale_contacts.begin(), stale_contacts.begin() + static_cast<std::ptrdiff_t>(anew));
  std::ranges::sort(stale_contacts);
}

void Checker::State::doubt(std::string text) {
  ++counters.doubts;
  if (findings.doubts.size() < kMostDoubts) findings.doubts.push_back(std::move(text));
}

std::string Checker::State::pair_text(const Found& found) const {
  const auto& pair = search.tracker().pairs()[found.pair];
  return short_name(pair.a) + " and " + short_name(pair.b);
}

void Checker::State::ask(const Found& found, const geometry::Contact* contact, PairHistory& pair,
                         const CellPoses& poses) {
  const auto& tracked = search.tracker().pairs()[found.pair];
  const Body& a = table->bodies[tracked.a];
  const Body& b = table->bodies[tracked.b];
  const double depth = contact == nullptr || contact->points.empty() ? 0.0 : contact->deepest.depth;
  ++counters.second_opinions;
  const Opinion opinion =
      second_opinion.ask(a, pose_of(a, poses), b, pose_of(b, poses), {pair.own_touching, found.at.distance, depth});
  pair.disputed = opinion != Opinion::agrees;
  if (pair.disputed) ++counters.disagreements;
}

void Checker::State::add_event(ProximityChange change, const Found& found) {
  const auto& pair = search.tracker().pairs()[found.pair];
  findings.events.push_back({next_event++, change, name(pair.a), name(pair.b), found.at.distance, findings.posture_time,
                             short_name(pair.a), short_name(pair.b)});
}

// Events nest: a pair that jumps from far to touching has entered the warning distance as well.
void Checker::State::change_zone(const Found& found, PairHistory& pair, Zone zone) {
  if (pair.zone == Zone::touching && zone != Zone::touching) add_event(ProximityChange::parted, found);
  if (pair.zone != Zone::far && zone == Zone::far) add_event(ProximityChange::left_warning, found);
  if (pair.zone == Zone::far && zone != Zone::far) add_event(ProximityChange::entered_warning, found);
  if (pair.zone != Zone::touching && zone == Zone::touching) add_event(ProximityChange::touched, found);
  pair.zone = zone;
  watched[found.pair] = zone == Zone::far ? 0 : 1;
}

void Checker::State::classify(const Found& found, const geometry::Contact* contact, bool its_turn,
                              const CellPoses& poses) {
  PairHistory& pair = history[found.pair];
  const bool settled = found.usable && found.at.plausible;
  const bool touching = !settled || found.at.distance <= geometry::kTouchDistance;
  if (settled) {
    const bool changed = touching != pair.own_touching;
    pair.own_touching = touching;
    const bool again = pair.disputed && disputes_left > 0;
    if (again) --disputes_left;
    if (changed || its_turn || again) ask(found, contact, pair, poses);
    if (!found.at.certain)
      doubt(fmt::format("the distance of {} could not be computed exactly: it is at least {:.6f} m", pair_text(found),
                        found.at.distance));
  } else if (found.usable) {
    doubt(fmt::format("the distance of {} is contradictory: treated as touching", pair_text(found)));
  }
  if (pair.disputed)
    doubt(fmt::format("two tests of {} disagree about contact: treated as touching", pair_text(found)));
  const bool taken_as_touching = touching || pair.disputed;
  // A pair leaves a little later than it comes, so that noise of a joint gives no stream of events.
  const double leave = settings.warning_distance_m + (pair.zone == Zone::far ? 0.0 : kLeaveMargin);
  const bool within = found.at.distance <= leave;
  change_zone(found, pair, taken_as_touching ? Zone::touching : within ? Zone::warning : Zone::far);
}

void Checker::State::add_touching(const Found& found, const geometry::Contact* contact, bool doubtful) {
  const auto& pair = search.tracker().pairs()[found.pair];
  TouchingPair& touching = findings.touching.emplace_back();
  touching.a = pair.a;
  touching.b = pair.b;
  touching.doubtful = doubtful;
  touching.contact_time = findings.posture_time;
  touching.point_m = 0.5 * (found.at.p_a + found.at.p_b);
  if (contact == nullptr || contact->points.empty()) return;
  touching.contact_time = history[found.pair].contact_time;
  touching.depth_m = contact->deepest.depth;
  touching.point_m = contact->deepest.p_W;
  touching.normal = contact->deepest.normal;
  for (const auto& point : contact->points) touching.points.push_back({point.p_W, point.normal, point.depth});
}

void Checker::State::add_near(const Found& found, bool doubtful, const CellPoses& poses, const CellPoses* later,
                              Nanoseconds ahead) {
  const auto& pair = search.tracker().pairs()[found.pair];
  const bool touching = history[found.pair].zone == Zone::touching;
  NearPair& near = findings.near.emplace_back();
  near.a = pair.a;
  near.b = pair.b;
  near.distance_m = touching ? 0.0 : found.at.distance;
  near.point_a_m = found.at.p_a;
  near.point_b_m = found.at.p_b;
  near.within_warning = history[found.pair].zone != Zone::far;
  near.doubtful = doubtful || !found.at.certain;
  if (touching || later == nullptr || ahead.count() <= 0 || later->X_WN.size() != poses.X_WN.size()) return;
  near.closing_speed_m_s = closing_speed(table->bodies[pair.a], table->bodies[pair.b], found.at, poses, *later, ahead);
  if (near.closing_speed_m_s && *near.closing_speed_m_s > kLeastSpeed)
    near.time_to_contact_s = near.distance_m / *near.closing_speed_m_s;
}

Checker::Checker() : state_(std::make_unique<State>()) {}
Checker::~Checker() = default;

const CheckCounters& Checker::counters() const { return state_->counters; }

void Checker::limit_contacts(std::size_t pairs, std::uint64_t period) {
  CELLMIRROR_EXPECTS(period > 0);
  state_->contact_limit = pairs;
  state_->contact_period = period;
}

void Checker::adopt(std::shared_ptr<const CompiledCell> cell, std::shared_ptr<const PairTable> pairs,
                    const Settings& settings) {
  State& state = *state_;
  CELLMIRROR_EXPECTS(cell != nullptr && pairs != nullptr && cell->revision == pairs->revision);
  std::map<std::pair<std::string, std::string>, PairHistory> known;
  for (std::size_t i = 0; i < state.history.size() && settings.active; ++i) {
    const auto& pair = state.search.tracker().pairs()[i];
    if (state.history[i].zone != Zone::far) known[{state.name(pair.a), state.name(pair.b)}] = state.history[i];
  }
  state.cell = std::move(cell);
  state.table = std::move(pairs);
  state.settings = settings;
  state.search.adopt(state.table);
  state.plain_search.adopt(state.table);
  state.second_opinion.keep_only(*state.table);
  const auto& tested = state.search.tracker().pairs();
  state.history.assign(tested.size(), {});
  state.watched.assign(tested.size(), 0);
  for (std::size_t i = 0; i < tested.size() && !known.empty(); ++i) {
    // The order of the nodes, and so of two bodies, may have changed.
    auto before = known.find({state.name(tested[i].a), state.name(tested[i].b)});
    if (before == known.end()) before = known.find({state.name(tested[i].b), state.name(tested[i].a)});
    if (before == known.end()) continue;
    state.history[i] = before->second;
    state.watched[i] = 1;
  }
}

const ProximityState& Checker::check(const CellPoses& poses, Timestamp posture_time, const CellPoses* later,
                                     Nanoseconds ahead) {
  State& state = *state_;
  CELLMIRROR_EXPECTS(state.table != nullptr && poses.X_WN.size() == state.cell->size());
  ProximityState& findings = state.findings;
  ++state.counters.checks;
  ++findings.sequence;
  findings.posture_time = posture_time;
  findings.names = state.table->names;
  findings.short_names = state.table->short_names;
  findings.warning_distance_m = state.settings.warning_distance_m;
  findings.pairs = state.settings.active ? state.history.size() : 0;
  findings.touching.clear();
  findings.near.clear();
  findings.events.clear();
  findings.doubts.clear();
  if (state.settings.active) {
    for (const std::string& text : state.table->doubts) state.doubt(text);
    const auto& found = state.search.find(poses, state.settings.warning_distance_m, state.watched);
    const auto& bodies = state.search.motion().bodies();
    for (std::size_t i = 0; i < bodies.size() && state.search.motion().unusable() > 0; ++i) {
      if (!bodies[i].usable)
        state.doubt(state.short_name(static_cast<std::uint32_t>(i)) + ": its pose is unknown; treated as touching");
    }
    state.disputes_left = kMostDisputes;
    state.choose_stale_contacts(found);
    const std::size_t turn = found.empty() ? 0 : state.round_robin++ % found.size();
    for (std::size_t i = 0; i < found.size(); ++i) state.classify(found[i], state.contact(found[i]), i == turn, poses);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const PairHistory& pair = state.history[found[i].pair];
      const bool doubtful = pair.disputed || !found[i].usable || !found[i].at.plausible;
      if (pair.zone == Zone::touching) state.add_touching(found[i], state.contact(found[i]), doubtful);
      state.add_near(found[i], doubtful, poses, later, ahead);
    }
    std::ranges::sort(findings.near, {},
                      [](const NearPair& near) { return std::tuple(near.distance_m, near.a, near.b); });
    // Beyond the warning distance only the nearest pair is reported.
    if (!findings.near.empty()) {
      const auto beyond = std::remove_if(findings.near.begin() + 1, findings.near.end(),
                                         [](const NearPair& near) { return !near.within_warning; });
      findings.near.erase(beyond, findings.near.end());
    }
    state.counters.pairs_computed = state.search.tracker().queries() + state.plain_search.tracker().queries();
  }
  return findings;
}

bool Checker::collides(const CellPoses& poses) {
  CELLMIRROR_EXPECTS(state_->table != nullptr && poses.X_WN.size() == state_->cell->size());
  return state_->plain_search.any_touch(poses);
}

}  // namespace cellmirror::collision
