// A triangle mesh that is fit for geometry: finite, welded, without degenerate triangles. make_mesh() (mesh_repair.hpp)
// is the only way from a file's triangles to one of these. Immutable once made; shared by std::shared_ptr.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cellmirror::geometry {

using TriangleIndices = std::array<std::uint32_t, 3>;  // counter-clockwise from outside if the mesh is closed

struct TriangleMesh {
  std::string name;                        // of the file, for messages
  std::vector<Eigen::Vector3d> vertices;   // m, in the frame G of its geometry (scale applied); no two are equal
  std::vector<TriangleIndices> triangles;  // into `vertices`; none has an area of zero, no duplicates
  // Every edge is run through by as many triangles in one direction as in the other (by one each, but where shells
  // touch along an edge), and the volume is positive: there is an inside, and what lies in it touches the body.
  bool closed = false;
  bool convex = false;  // closed, and a convex polyhedron (hulls and pieces of decompositions)
};

}  // namespace cellmirror::geometry
