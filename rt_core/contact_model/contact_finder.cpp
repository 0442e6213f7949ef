#include "rt_core/contact_model/contact_finder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "rt_core/contact_model/levers.hpp"
#include "rt_core/contact_model/pair_query.hpp"
#include "rt_core/contact_model/pieces.hpp"
#include "rt_core/contact_model/selection.hpp"

namespace cellmirror::contact_model {

namespace {

using Eigen::Vector3d;

// Points that the tip moves less than this, a metre, it cannot keep away from anything.
constexpr double kLeastLever = 0.02;
constexpr double kMostLever = 10.0;
constexpr std::size_t kMostCandidates = 4096;
constexpr int kMostHalvings = 6;
// Depth to which a place without a plane may be entered: minimum, and as a fraction of the distance to it.
constexpr double kEntered = 5e-5;  // m
constexpr double kEnteredOnTheWay = 0.05;
// However crooked the surface, the tip may go so far.
constexpr double kLeastReach = 0.001;  // m

bool can_be_computed_with(const Pose& X) { return X.matrix().allFinite() && X.translation().norm() < 1e6; }

}  // namespace

struct ContactFinder::State {
  // A piece of the instrument and the pieces that it is tested against.
  struct Watched {
    std::uint32_t piece = 0;
    std::uint32_t first = 0;  // into `others`
    std::uint32_t count = 0;
  };

  State(std::size_t slot_in, const FinderSettings& settings_in)
      : slot(slot_in), settings(settings_in), query(settings_in.margin_m) {
    candidates.reserve(kMostCandidates);
    refused.reserve(kMostCandidates);
    planes.reserve(kMostCandidates);
  }

  void adopt();
  [[nodiscard]] bool place(std::vector<Piece>& pieces, const CellPoses& poses) const;
  [[nodiscard]] double largest_lever(const Piece& piece) const;
  // False: it has to be tried with less reach.
  [[nodiscard]] bool gather(double reach, haptics::ContactModel& out);
  void fill(double reach, haptics::ContactModel& out);
  void shorten(haptics::ContactModel& out) const;

  std::size_t slot;
  FinderSettings settings;
  std::shared_ptr<const CompiledCell> cell;
  std::shared_ptr<const collision::PairTable> pairs;
  const CompiledRobot* robot = nullptr;
  SurfaceLibrary surfaces;
  Levers levers;
  std::vector<Piece> instrument;
  std::vector<Piece> surroundings;
  std::vector<Watched> watched;
  std::vector<std::uint32_t> others;  // into `surroundings`
  PairQuery query;
  std::vector<Candidate> candidates;
  std::vector<Candidate> refused;
  std::vector<TipPlane> planes;
  FinderCounters counters;
};

void ContactFinder::State::adopt() {
  instrument.clear();
  surroundings.clear();
  watched.clear();
  others.clear();
  robot = cell && pairs ? cell->robot(slot) : nullptr;
  if (robot == nullptr) return;
  levers.adopt(*cell, *robot);
  const auto& bodies = pairs->bodies;
  std::vector<std::vector<std::uint32_t>> partners(bodies.size());
  for (const collision::Pair& pair : pairs->pairs) {
    const bool moves_a = levers.moves(bodies[pair.a].node);
    if (!is_tested(pair.state) || moves_a == levers.moves(bodies[pair.b].node)) continue;
    moves_a ? partners[pair.a].push_back(pair.b) : partners[pair.b].push_back(pair.a);
  }
  // Pieces of a body are adjacent.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> range(bodies.size());
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    std::vector<Piece>& list = levers.moves(bodies[i].node) ? instrument : surroundings;
    range[i].first = static_cast<std::uint32_t>(list.size());
    append_pieces(bodies[i], &list == &instrument, surfaces, list);
    range[i].second = static_cast<std::uint32_t>(list.size());
  }
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (partners[i].empty()) continue;
    const auto first = static_cast<std::uint32_t>(others.size());
    for (const std::uint32_t other : partners[i]) {
      for (std::uint32_t k = range[other].first; k < range[other].second; ++k) others.push_back(k);
    }
    const auto count = static_cast<std::uint32_t>(others.size()) - first;
    for (std::uint32_t k = range[i].first; k < range[i].second; ++k) watched.push_back({k, first, count});
  }
  surfaces.forget_unused();
}

bool ContactFinder::State::place(std::vector<Piece>& pieces, const CellPoses& poses) const {
  bool all = true;
  for (Piece& piece : pieces) {
    const Pose& X_WN = poses.X_WN[static_cast<std::size_t>(piece.node)];
    piece.usable = can_be_computed_with(X_WN);
    all = all && piece.usable;
    if (piece.usable) piece.place(X_WN);
  }
  return all;
}

// The lever is an affine function of the point: none within the box has a greater one than some corner.
double ContactFinder::State::largest_lever(const Piece& piece) const {
  double most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    const Vector3d p = piece.placed.centre + piece.placed.R * sign.cwiseProduct(piece.placed.half);
    most = std::max(most, levers.lever(piece.node, p).norm());
  }
  return most;
}

bool ContactFinder::State::gather(double reach, haptics::ContactModel& out) {
  candidates.clear();
  refused.clear();
  bool overlapping = false;
  std::uint32_t last_overlap_part = ~0U;
  std::uint32_t last_overlap_other = ~0U;
  for (const Watched& watch : watched) {
    const Piece& piece = instrument[watch.piece];
    if (!piece.usable) continue;
    const double lever = largest_lever(piece);
    if (lever < kLeastLever) continue;
    const double piece_reach = reach * std::min(lever, kMostLever) + settings.margin_m;
    for (std::uint32_t k = 0; k < watch.count; ++k) {
      const std::uint32_t index = others[watch.first + k];
      const Piece& other = surroundings[index];
      if (!other.usable || lower_bound(piece.placed, other.placed, piece_reach) > piece_reach) continue;
      const bool new_overlap = piece.part != last_overlap_part || index != last_overlap_other;
      const QueryResult result = query.ask(piece, other, piece_reach, new_overlap, candidates);
      if (result == QueryResult::crowded || candidates.size() > kMostCandidates) return false;
      if (refused.size() + query.refused().size() > kMostCandidates) return false;
      refused.insert(refused.end(), query.refused().begin(), query.refused().end());
      out.certain = out.certain && result == QueryResult::done;
      if (!query.overlapped()) continue;
      overlapping = true;
      last_overlap_part = piece.part;
      last_overlap_other = index;
    }
  }
  if (overlapping) ++counters.overlaps;
  return true;
}

void ContactFinder::State::fill(double reach, haptics::ContactModel& out) {
  planes.clear();
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    TipPlane plane;
    plane.candidate = i;
    plane.unit = levers.lever(candidate.node, candidate.point).transpose() * candidate.normal;
    plane.lever = plane.unit.norm();
    if (!(plane.lever > kLeastLever)) continue;
    plane.unit /= plane.lever;
    plane.gap = candidate.gap / plane.lever;
    if (plane.gap < reach) planes.push_back(plane);
  }
  const Selection selection = select(planes, reach);
  out.reach = selection.reach;
  out.count = static_cast<std::uint8_t>(selection.count);
  for (std::size_t i = 0; i < selection.count; ++i) {
    const TipPlane& plane = planes[selection.chosen[i]];
    const Candidate& candidate = candidates[plane.candidate];
    out.constraints[i] = {plane.lever * plane.unit, candidate.gap, candidate.normal, candidate.point};
  }
  std::sort(out.constraints.begin(), out.constraints.begin() + out.count,
            [](const auto& a, const auto& b) { return a.gap < b.gap; });
}

// On a surface that bends both ways no few planes are both safe and free. So the tip may not go as far as to a place
// that it would enter there before a new model says more.
void ContactFinder::State::shorten(haptics::ContactModel& out) const {
  for (const Candidate& place : refused) {
    const Eigen::Matrix3d lever = levers.lever(place.node, place.point);
    if (!(std::abs(lever.determinant()) > kLeastLever * kLeastLever)) continue;
    const Vector3d way = lever.inverse() * (place.surface - place.point);
    const double length = way.norm();
    if (!(length < out.reach)) continue;
    double room = length;
    for (std::size_t i = 0; i < out.count; ++i) {
      room = std::min(room, out.constraints[i].a.dot(way) + out.constraints[i].gap);
    }
    if (room > std::max(kEntered, kEnteredOnTheWay * length)) out.reach = std::max(length, kLeastReach);
  }
}

ContactFinder::ContactFinder(std::size_t slot, const FinderSettings& settings)
    : state_(std::make_unique<State>(slot, settings)) {}
ContactFinder::~ContactFinder() = default;

void ContactFinder::adopt(std::shared_ptr<const CompiledCell> cell, std::shared_ptr<const collision::PairTable> pairs) {
  // The old ones go after their parts are no longer pointed at.
  const auto old_pairs = std::exchange(state_->pairs, std::move(pairs));
  state_->cell = std::move(cell);
  state_->adopt();
}

void ContactFinder::find(const CellPoses& poses, Timestamp posture_time, haptics::ContactModel& out) {
  State& s = *state_;
  out.sequence = 0;
  out.posture_time = posture_time;
  out.slot = static_cast<std::uint8_t>(s.slot);
  out.count = 0;
  out.reach = 0;
  out.certain = false;
  if (s.robot == nullptr || poses.X_WN.size() != s.cell->size()) return;
  s.levers.move(poses);
  out.x_ref = s.levers.tip();
  if (!out.x_ref.allFinite()) return;
  out.sequence = ++s.counters.models;
  const bool placed_instrument = s.place(s.instrument, poses);
  const bool placed_surroundings = s.place(s.surroundings, poses);
  out.certain = placed_instrument && placed_surroundings;
  double reach = s.settings.reach_m;
  int halvings = 0;
  while (!s.gather(reach, out)) {
    reach *= 0.5;
    if (++halvings <= kMostHalvings) continue;
    // The tip stays at rest until a result is available.
    out.certain = false;
    out.reach = reach;
    return;
  }
  s.fill(reach, out);
  s.shorten(out);
  if (!out.certain) ++s.counters.uncertain;
  if (out.reach < s.settings.reach_m) ++s.counters.short_reach;
}

const FinderCounters& ContactFinder::counters() const { return state_->counters; }

}  // namespace cellmirror::contact_model
