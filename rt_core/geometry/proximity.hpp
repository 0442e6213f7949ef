// Distance, touch and contact of two solids of any kind. Exact: every triangle counts; a body inside of a closed one
// touches it. No heap memory in steady state; noexcept; any thread. Not for the tick: the time depends on the meshes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/closest.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror::geometry {

// Surfaces that are nearer than this touch, m: below what double numbers resolve far from the origin.
inline constexpr double kTouchDistance = 1e-9;

// Where the last query about a pair ended; the next one, a little later, starts there and is much faster. Any value
// gives a right answer. One a pair and thread.
struct ProximityHint {
  std::uint32_t feature_a = 0;  // triangle in the order of the tree
  std::uint32_t feature_b = 0;
  bool known = false;
};

struct Separation {
  ClosestPoints points;  // in frame W
  bool beyond = false;   // farther apart than requested: points.distance is a lower bound, the points are not set
  bool certain =
      true;  // false: an iteration ended early and points.distance is a lower bound. To be reported as doubtful.
};

// The distance where it is below `up_to` (m, not negative). Symmetric.
[[nodiscard]] Separation separation(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB, double up_to,
                                    ProximityHint& hint) noexcept;
// Whether they touch, overlap, or one is inside of the other.
[[nodiscard]] bool touch(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB,
                         ProximityHint& hint) noexcept;

struct ContactPoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit vector in W, from a to b
  double depth = 0;                                  // m
};

struct Contact {
  ContactPoint deepest;
  std::vector<ContactPoint> points;  // at most `most`, spread over the contact, deepest first
};

// Of solids that touch; false where they do not. Two convex solids: depth is the shortest translation that separates
// them. Else it is the greatest depth of one's surface below the other's (0 between open surfaces, which have no
// inside). Bounded work: of very many intersecting triangles only a part is examined (contact_surfaces.hpp), so that
// points and depth are those of the part; whether the solids touch never depends on that. Unlike the others it may take
// heap memory, until each thread has met its largest contact.
bool contact(const Solid& a, const Pose& X_WA, const Solid& b, const Pose& X_WB, std::size_t most,
             Contact& out) noexcept;

}  // namespace cellmirror::geometry
