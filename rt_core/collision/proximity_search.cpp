#include "rt_core/collision/proximity_search.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace cellmirror::collision {

namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();
// A pair that was measured is worth a bound that lasts for about so many frames of its present motion.
constexpr double kFramesAhead = 24.0;
// Limit (m) of the search beyond the requested distance: postures that jump have no next frame to save for.
constexpr double kWidestMargin = 0.1;

}  // namespace

void ProximitySearch::adopt(std::shared_ptr<const PairTable> table) {
  table_ = std::move(table);
  motion_.adopt(table_);
  tracker_.adopt(*table_, motion_);
  candidates_.reserve(tracker_.pairs().size());
  nearest_known_ = false;
  last_touch_ = 0;
}

void ProximitySearch::move(const CellPoses& poses) {
  if (motion_.worn()) {
    motion_.restart();
    tracker_.forget_bounds();
  }
  motion_.move(poses);
}

bool ProximitySearch::usable(const PairTracker::Tracked& pair) const {
  return motion_.bodies()[pair.a].usable && motion_.bodies()[pair.b].usable;
}

double ProximitySearch::margin(const PairTracker::Tracked& pair) const {
  const double wanted = kFramesAhead * (motion_.bodies()[pair.a].step + motion_.bodies()[pair.b].step);
  return wanted <= kWidestMargin ? wanted : 0.0;
}

void ProximitySearch::measure(std::uint32_t pair, double up_to) {
  Found& found = found_.emplace_back();
  found.pair = pair;
  found.at = tracker_.distance(pair, up_to);
  if (found.at.beyond || found.at.distance > least_) return;
  if (found.at.distance == least_ && nearest_known_ && nearest_ < pair) return;
  least_ = found.at.distance;
  nearest_ = pair;
  nearest_known_ = true;
}

// Pairs that may be nearer than `up_to`, and the watched ones.
void ProximitySearch::gather(double up_to, const std::vector<std::uint8_t>& watched) {
  const std::vector<double>& travelled = motion_.travelled();
  const auto& pairs = tracker_.pairs();
  candidates_.clear();
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    double bound = tracker_.bound(pairs[i], travelled);
    if (bound > up_to && watched[i] == 0) continue;
    if (!usable(pairs[i])) {
      found_.push_back({i, {}, false});
      continue;
    }
    bound = tracker_.refine(i, up_to);
    if (bound <= up_to || watched[i] != 0) candidates_.push_back({bound, i});
  }
  std::ranges::sort(candidates_, {}, &Candidate::bound);
}

const std::vector<Found>& ProximitySearch::find(const CellPoses& poses, double warning,
                                                const std::vector<std::uint8_t>& watched) {
  move(poses);
  found_.clear();
  least_ = kNoBound;
  // What was nearest still is, or nearly so: a good limit for all others.
  const bool begun = nearest_known_ && usable(tracker_.pairs()[nearest_]);
  const std::uint32_t first = nearest_;
  nearest_known_ = false;
  if (begun) measure(first, kNoBound);
  gather(std::max(warning, least_), watched);
  for (const Candidate& candidate : candidates_) {
    if (begun && candidate.pair == first) continue;
    const double limit = std::max(warning, least_);
    const bool wanted = watched[candidate.pair] != 0;
    if (candidate.bound > limit && !wanted) continue;
    const bool unlimited = wanted || least_ == kNoBound;
    measure(candidate.pair, unlimited ? kNoBound : limit + margin(tracker_.pairs()[candidate.pair]));
  }
  std::erase_if(found_, [&](const Found& found) {
    if (!found.usable || watched[found.pair] != 0 || (nearest_known_ && found.pair == nearest_)) return false;
    return found.at.beyond || found.at.distance > warning;
  });
  std::ranges::sort(found_, {}, &Found::pair);
  return found_;
}

bool ProximitySearch::any_touch(const CellPoses& poses) {
  move(poses);
  if (motion_.unusable() > 0) return !tracker_.pairs().empty();
  const std::vector<double>& travelled = motion_.travelled();
  const auto& pairs = tracker_.pairs();
  const auto touches = [&](std::uint32_t i) {
    return tracker_.bound(pairs[i], travelled) <= 0.0 && tracker_.refine(i, 0.0) <= 0.0 && tracker_.touches(i);
  };
  if (last_touch_ < pairs.size() && touches(last_touch_)) return true;
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    if (!touches(i)) continue;
    last_touch_ = i;
    return true;
  }
  return false;
}

}  // namespace cellmirror::collision
