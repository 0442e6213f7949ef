#include "rt_core/collision/pair_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cellmirror::collision {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What every answer of the narrow phase must satisfy.
bool plausible(const geometry::Separation& found) {
  const double distance = found.points.distance;
  if (!std::isfinite(distance) || distance < 0) return found.beyond && distance > 0;
  if (found.beyond) return true;
  const auto& points = found.points;
  if (!points.p_a.allFinite() || !points.p_b.allFinite()) return false;
  const double scale = 1.0 + std::max(points.p_a.cwiseAbs().maxCoeff(), points.p_b.cwiseAbs().maxCoeff());
  return std::abs((points.p_b - points.p_a).norm() - distance) <= 2e-6 * scale;
}

}  // namespace

void PairTracker::adopt(const PairTable& table, const BodyMotion& motion) {
  motion_ = &motion;
  pairs_.clear();
  for (const Pair& pair : table.pairs) {
    if (is_tested(pair.state)) pairs_.push_back({pair.a, pair.b, -kInfinity});
  }
  memory_.clear();
  memory_.resize(pairs_.size());
}

void PairTracker::forget_bounds() {
  for (Tracked& pair : pairs_) pair.known = -kInfinity;
  for (const auto& memory : memory_) {
    if (!memory) continue;
    for (Item& item : memory->items) item.known = -kInfinity;
  }
}

void PairTracker::relative(const Tracked& pair, Eigen::Matrix3d& R, Eigen::Vector3d& p) const {
  // The smaller body is seen from the larger one: turning the larger would seem to move the other far.
  const MovingBody* large = &motion_->bodies()[pair.a];
  const MovingBody* small = &motion_->bodies()[pair.b];
  if (small->placed.radius > large->placed.radius) std::swap(large, small);
  R.noalias() = large->X_WN.linear().transpose() * small->X_WN.linear();
  p.noalias() = large->X_WN.linear().transpose() * (small->placed.centre - large->X_WN.translation());
}

double PairTracker::refine(std::size_t index, double enough) {
  Tracked& pair = pairs_[index];
  const MovingBody& a = motion_->bodies()[pair.a];
  const MovingBody& b = motion_->bodies()[pair.b];
  const double travelled = motion_->travelled()[pair.a] + motion_->travelled()[pair.b];
  double bound = std::max(pair.known - travelled, lower_bound(a.placed, b.placed, enough));
  const Memory* memory = memory_[index].get();
  if (bound <= enough && memory != nullptr && memory->distance_then > enough) {
    Eigen::Matrix3d R;
    Eigen::Vector3d p;
    relative(pair, R, p);
    const double radius = std::min(a.placed.radius, b.placed.radius);
    const double moved = travel(memory->R_then, R, (p - memory->p_then).norm(), radius);
    bound = std::max(bound, memory->distance_then - moved - kBoundSlack);
  }
  pair.known = bound + travelled;
  return bound;
}

PairTracker::Memory& PairTracker::memory_of(std::size_t index) {
  std::unique_ptr<Memory>& memory = memory_[index];
  if (memory) return *memory;
  memory = std::make_unique<Memory>();
  const std::uint32_t parts_a = motion_->bodies()[pairs_[index].a].part_count;
  const std::uint32_t parts_b = motion_->bodies()[pairs_[index].b].part_count;
  memory->items.reserve(static_cast<std::size_t>(parts_a) * parts_b);
  for (std::uint32_t i = 0; i < parts_a; ++i) {
    for (std::uint32_t k = 0; k < parts_b; ++k) memory->items.push_back({i, k, -kInfinity, {}});
  }
  return *memory;
}

std::uint64_t PairTracker::moved_frame(const Tracked& pair) const {
  return std::max(motion_->bodies()[pair.a].moved_frame, motion_->bodies()[pair.b].moved_frame);
}

// Parts that may be nearer than `up_to`, the most promising first.
void PairTracker::gather(const Tracked& pair, Memory& memory, double up_to) {
  const double travelled = motion_->travelled()[pair.a] + motion_->travelled()[pair.b];
  const MovingBody& a = motion_->bodies()[pair.a];
  const MovingBody& b = motion_->bodies()[pair.b];
  candidates_.clear();
  for (std::uint32_t i = 0; i < memory.items.size(); ++i) {
    Item& item = memory.items[i];
    double bound = item.known - travelled;
    if (bound < up_to && memory.items.size() > 1) {
      const MovingPart& part_a = motion_->part(a, item.part_a);
      const MovingPart& part_b = motion_->part(b, item.part_b);
      bound = std::max(bound, lower_bound(part_a.placed, part_b.placed, up_to));
      item.known = bound + travelled;
    }
    if (bound < up_to) candidates_.push_back({bound, i});
  }
  if (candidates_.size() > 1) std::ranges::sort(candidates_, {}, &Candidate::bound);
}

void PairTracker::measure(const Tracked& pair, Memory& memory, double up_to) {
  const double travelled = motion_->travelled()[pair.a] + motion_->travelled()[pair.b];
  const MovingBody& a = motion_->bodies()[pair.a];
  const MovingBody& b = motion_->bodies()[pair.b];
  PairDistance& nearest = memory.last;
  nearest = {};
  nearest.beyond = true;
  double least = up_to;
  for (const Candidate& candidate : candidates_) {
    if (candidate.bound >= least) break;
    Item& item = memory.items[candidate.item];
    const MovingPart& part_a = motion_->part(a, item.part_a);
    const MovingPart& part_b = motion_->part(b, item.part_b);
    const auto found = geometry::separation(*part_a.solid, part_a.X_WG, *part_b.solid, part_b.X_WG, least, item.hint);
    ++queries_;
    if (!plausible(found)) {
      nearest = {};
      nearest.plausible = false;
      item.known = travelled;
      return;
    }
    const double distance = found.beyond ? std::max(found.points.distance, least) : found.points.distance;
    item.known = distance - kBoundSlack + travelled;
    if (found.beyond || distance >= least) continue;
    least = distance;
    nearest = {distance, found.points.p_a, found.points.p_b, false, found.certain, true};
    if (distance <= geometry::kTouchDistance) {
      nearest.distance = 0;
      return;
    }
  }
  if (!nearest.beyond) return;
  nearest.distance = kInfinity;
  for (const Item& item : memory.items) nearest.distance = std::min(nearest.distance, item.known - travelled);
}

const PairDistance& PairTracker::distance(std::size_t index, double up_to) {
  Tracked& pair = pairs_[index];
  Memory& memory = memory_of(index);
  // What lies beyond the limit has a bound that may be a little below it: the limit tells whether another query could
  // find more. Else equally near pairs, e.g. of equal arms, were measured in each frame though nothing moves.
  const bool enough = !memory.last.beyond || std::max(memory.last.distance, memory.up_to) >= up_to;
  if (memory.frame != 0 && moved_frame(pair) <= memory.frame && enough) return memory.last;
  gather(pair, memory, up_to);
  measure(pair, memory, up_to);
  memory.up_to = up_to;
  memory.frame = motion_->frame();
  relative(pair, memory.R_then, memory.p_then);
  memory.distance_then = memory.last.distance;
  pair.known = memory.last.distance - kBoundSlack + motion_->travelled()[pair.a] + motion_->travelled()[pair.b];
  return memory.last;
}

const geometry::Contact& PairTracker::contact(std::size_t index) {
  const Tracked& pair = pairs_[index];
  Memory& memory = memory_of(index);
  geometry::Contact& out = memory.contact;
  if (memory.contact_frame != 0 && moved_frame(pair) <= memory.contact_frame) return out;
  memory.contact_frame = motion_->frame();
  const MovingBody& a = motion_->bodies()[pair.a];
  const MovingBody& b = motion_->bodies()[pair.b];
  out.points.clear();
  gather(pair, memory, geometry::kTouchDistance);
  for (const Candidate& candidate : candidates_) {
    const Item& item = memory.items[candidate.item];
    const MovingPart& part_a = motion_->part(a, item.part_a);
    const MovingPart& part_b = motion_->part(b, item.part_b);
    ++queries_;
    if (!geometry::contact(*part_a.solid, part_a.X_WG, *part_b.solid, part_b.X_WG, kMostContactPoints, part_contact_))
      continue;
    out.points.insert(out.points.end(), part_contact_.points.begin(), part_contact_.points.end());
  }
  if (out.points.empty()) return out;
  std::ranges::sort(out.points, std::ranges::greater{}, &geometry::ContactPoint::depth);
  if (out.points.size() > kMostContactPoints) out.points.resize(kMostContactPoints);
  out.deepest = out.points.front();
  return out;
}

bool PairTracker::touches(std::size_t index) {
  const Tracked& pair = pairs_[index];
  Memory& memory = memory_of(index);
  const MovingBody& a = motion_->bodies()[pair.a];
  const MovingBody& b = motion_->bodies()[pair.b];
  gather(pair, memory, geometry::kTouchDistance);
  for (const Candidate& candidate : candidates_) {
    Item& item = memory.items[candidate.item];
    const MovingPart& part_a = motion_->part(a, item.part_a);
    const MovingPart& part_b = motion_->part(b, item.part_b);
    ++queries_;
    if (geometry::touch(*part_a.solid, part_a.X_WG, *part_b.solid, part_b.X_WG, item.hint)) return true;
  }
  return false;
}

}  // namespace cellmirror::collision
