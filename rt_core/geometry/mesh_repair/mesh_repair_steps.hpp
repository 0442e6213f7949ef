// The steps of make_mesh(). Private to this folder.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror::geometry {

using Vertices = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<TriangleIndices>;
using Origins = std::vector<std::uint32_t>;  // by triangle

// One side of a triangle, to be sorted by edge.
struct EdgeUse {
  std::uint64_t edge = 0;  // smaller vertex in the upper half
  std::uint32_t triangle = 0;
  bool forward = false;  // runs from the smaller to the larger vertex
};

[[nodiscard]] inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  constexpr unsigned kHalf = 32;
  return a < b ? (std::uint64_t{a} << kHalf) | b : (std::uint64_t{b} << kHalf) | a;
}

// The uses of all edges, those of one edge side by side, in the order of the triangles.
[[nodiscard]] std::vector<EdgeUse> edge_uses(const Triangles& triangles);
// The uses of one edge; empty where there are none.
[[nodiscard]] std::span<const EdgeUse> uses_of(const std::vector<EdgeUse>& uses, std::uint64_t edge);
// Calls visit(span of the uses of one edge) for every edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t from = 0; from < uses.size();) {
    std::size_t to = from + 1;
    while (to < uses.size() && uses[to].edge == uses[from].edge) ++to;
    visit(std::span(uses).subspan(from, to - from));
    from = to;
  }
}

// Makes vertices that are nearer than the tolerance one; the first stays as it is. Returns how many went.
std::size_t weld(Vertices& vertices, Triangles& triangles);
// Removes triangles without area so that closed meshes stay closed: a flat triangle splits its neighbour.
// `origins` goes along with the triangles: those that are removed leave it too, a piece of a split one has its origin.
void remove_degenerate(const Vertices& vertices, Triangles& triangles, Origins& origins, MeshFindings& findings);
void remove_duplicates(Triangles& triangles, Origins& origins, MeshFindings& findings);
// Makes neighbours face the same way and closed shells outwards; says whether the mesh is closed.
bool orient(const Vertices& vertices, Triangles& triangles, MeshFindings& findings);
// How often the triangles go round p: 1 inside of a closed mesh that faces outwards, 0 outside. Source: van Oosterom,
// Strackee 1983 (solid angle of a triangle).
[[nodiscard]] double winding_number(const Vertices& vertices, const Triangles& triangles,
                                    std::span<const std::uint32_t> which, const Eigen::Vector3d& p);
// Forgets vertices without triangles.
void remove_unused(Vertices& vertices, Triangles& triangles);

}  // namespace cellmirror::geometry
