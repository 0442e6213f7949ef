// Convex polyhedra by their faces, edges and corners, and the shortest way that parts two of them. For the depth of
// contacts; not for the tick.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/convex.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::geometry {

struct Polytope {
  struct Face {
    Eigen::Vector3d normal;  // unit vector, outwards
    double offset = 0;       // m: normal * p of its points
  };
  // A direction at right angles to the edge is one in which no corner reaches farther than the edge if it is on the
  // inner side of both: `from_one` * n >= 0 and `from_other` * n >= 0. Zero vectors: of a segment, which has no faces.
  struct Edge {
    Eigen::Vector3d point;      // m, one end
    Eigen::Vector3d direction;  // unit vector
    Eigen::Vector3d from_one;
    Eigen::Vector3d from_other;
  };
  std::vector<Eigen::Vector3d> corners;
  std::vector<Face> faces;
  std::vector<Edge> edges;
};

// Larger ones take too long to compare.
inline constexpr std::size_t kMostPolytopeTriangles = 1000;

// Of a mesh that is closed, convex (its flag says so, or it is small enough to look) and not too large; else nothing.
[[nodiscard]] std::optional<Polytope> polytope_of(const TriangleMesh& mesh);
// Of a core without its skin. A cylinder is taken as a prism around it, at most 0.13 percent of its radius too thick.
// Overwrites `out`, whose memory is used again.
void polytope_of(const ConvexCore& core, Polytope& out);
void move_polytope(const Polytope& from, const Pose& X, Polytope& out);

struct PolytopeOverlap {
  double depth = 0;                                   // m; negative: they are apart
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // from a to b
};

// Exact: the difference of two convex polyhedra has no faces but those of either and those that two edges span.
[[nodiscard]] PolytopeOverlap least_overlap(const Polytope& a, const Polytope& b) noexcept;

}  // namespace cellmirror::geometry
