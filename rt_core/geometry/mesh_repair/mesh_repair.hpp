// Converts the triangles of a file to a valid mesh: welds vertices, removes duplicates and triangles without area,
// orients, and determines whether there is an inside. Invalid meshes are refused; changes are reported. Not for the
// tick: O(n log n) with heap memory. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::geometry {

inline constexpr std::size_t kMostTriangles = 2'000'000;  // of one mesh
inline constexpr double kLargestCoordinate = 1e6;         // m
// Vertices that are nearer to each other than this part of the mesh's size (diagonal of the box around it) are one.
inline constexpr double kWeldTolerance = 1e-9;

// What make_mesh() found and did.
struct MeshFindings {
  std::size_t welded_vertices = 0;       // were equal to another one; usual, since STL has no indices
  std::size_t degenerate_triangles = 0;  // dropped or turned into a split of their neighbour: no area
  std::size_t duplicate_triangles = 0;   // dropped: the same corners as another one
  std::size_t back_to_back = 0;          // of these: facing the other way, as sheets that are drawn from both sides
  std::size_t flipped_triangles = 0;     // faced another way than their neighbours
  std::size_t inside_out_shells = 0;     // closed shells that were turned outside
  std::size_t shells = 0;                // connected by edges
  std::size_t open_edges = 0;            // with one triangle
  std::size_t crowded_edges = 0;         // with three triangles or more that do not run through it in pairs
  bool not_orientable = false;           // some shell has one side only, as a Moebius strip
  bool flat_shell = false;               // some shell is closed and has no volume
  bool too_nested = false;               // too many shells turned inwards to see which are cavities
  // Lines (triangles without area) that are no edge of any triangle that is left: they are lost to collision tests.
  std::size_t lost_lines = 0;
  double longest_lost_m = 0;

  // What is worth knowing about, each as a part of a sentence: "12 triangles without area were removed".
  [[nodiscard]] std::vector<std::string> repairs() const;
  // Why the mesh is no solid body: "3 edges belong to one triangle only"; empty where it is closed.
  [[nodiscard]] std::string why_open() const;
};

// `vertices` in m. Refused: coordinates that are not finite or beyond kLargestCoordinate, indices without a vertex,
// more than kMostTriangles triangles, and meshes of which no triangle is left. `findings` are filled in either way.
// `origins`, where given, gets for each triangle of the mesh the index of the one of `triangles` in whose plane it
// lies: the same one, turned or as it was, or one that was split.
[[nodiscard]] Result<TriangleMesh> make_mesh(std::string name, std::vector<Eigen::Vector3d> vertices,
                                             std::vector<TriangleIndices> triangles, MeshFindings& findings,
                                             std::vector<std::uint32_t>* origins = nullptr);

// Positive where the triangles of a closed mesh face outwards, m3.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

}  // namespace cellmirror::geometry
