// Distance between two bodies of several parts, without any memory of earlier poses.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/collision/bounds.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::collision {

// Both bodies outlive it. One thread.
class BodyProximity {
 public:
  BodyProximity(const Body& a, const Body& b);

  // m, where it is below `up_to`; else anything from `up_to` on. X_AB: of b's node in a's.
  [[nodiscard]] double distance(const Pose& X_AB, double up_to);

 private:
  struct Candidate {
    double bound = 0;
    std::size_t pair = 0;
  };
  struct PlacedPart {
    OrientedBox box;
    PlacedBox placed;
  };

  const Body& a_;
  const Body& b_;
  std::vector<PlacedPart> parts_a_;
  std::vector<PlacedPart> parts_b_;
  std::vector<geometry::ProximityHint> hints_;  // by pair of parts
  std::vector<Candidate> candidates_;
};

}  // namespace cellmirror::collision
