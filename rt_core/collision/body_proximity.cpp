#include "rt_core/collision/body_proximity.hpp"

#include <algorithm>

namespace cellmirror::collision {

BodyProximity::BodyProximity(const Body& a, const Body& b) : a_(a), b_(b) {
  const auto place = [](const Body& body, std::vector<PlacedPart>& parts) {
    for (const BodyPart& part : body.parts) {
      PlacedPart& placed = parts.emplace_back();
      placed.box = box_around(part);
      placed.placed.half = placed.box.half;
      placed.placed.radius = part.solid->radius;
      placed.placed.place(Pose::Identity(), placed.box);
    }
  };
  place(a, parts_a_);
  place(b, parts_b_);
  hints_.resize(parts_a_.size() * parts_b_.size());
  candidates_.reserve(hints_.size());
}

double BodyProximity::distance(const Pose& X_AB, double up_to) {
  for (PlacedPart& part : parts_b_) part.placed.place(X_AB, part.box);
  candidates_.clear();
  for (std::size_t i = 0; i < parts_a_.size(); ++i) {
    for (std::size_t k = 0; k < parts_b_.size(); ++k) {
      const double bound = lower_bound(parts_a_[i].placed, parts_b_[k].placed, up_to);
      if (bound < up_to) candidates_.push_back({bound, i * parts_b_.size() + k});
    }
  }
  std::ranges::sort(candidates_, {}, &Candidate::bound);
  double least = up_to;
  for (const Candidate& candidate : candidates_) {
    if (candidate.bound >= least || least <= 0) break;
    const BodyPart& a = a_.parts[candidate.pair / parts_b_.size()];
    const BodyPart& b = b_.parts[candidate.pair % parts_b_.size()];
    const auto found = geometry::separation(*a.solid, a.X_NG, *b.solid, X_AB * b.X_NG, least, hints_[candidate.pair]);
    if (!found.beyond) least = std::min(least, found.points.distance);
  }
  return least;
}

}  // namespace cellmirror::collision
