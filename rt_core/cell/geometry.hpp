// What is drawn and tested for collision at a node. Plain data, SI.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/shape.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror {

struct MeshAppearance;

// Substitute for a mesh in collision tests and ranging. Others than `exact` are used only if the cell or component file
// selects them.
enum class CollideAs : std::uint8_t {
  exact,  // every triangle
  hull,   // the convex hull
  parts,  // a convex decomposition
};

struct Geometry {
  std::string name;  // may be empty
  Shape shape = Shape::box;
  // box: edge lengths x, y, z. cylinder: radius, length, 0. sphere: radius, 0, 0. capsule: radius, length of the
  // cylindrical part, 0. mesh: scale factors. Metres (mesh: none); all positive where used.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  std::string mesh_file;  // absolute path
  // Shape mesh: the file's triangles, scaled, in frame G; shared by all that use the file with the same scale. Null
  // only where the geometry was made without reading files (tests).
  std::shared_ptr<const geometry::TriangleMesh> mesh;
  std::shared_ptr<const MeshAppearance> look;  // its pictures and colours, for drawing alone; null where it has none
  CollideAs collide_as = CollideAs::exact;
  std::vector<std::shared_ptr<const geometry::TriangleMesh>> pieces;  // convex; for `hull` (one) and `parts`
  Pose X_NG = Pose::Identity();                                       // pose in the node
  std::array<float, 4> rgba{0.72F, 0.72F, 0.74F, 1.0F};               // 0..1
  bool drawn = true;
  bool collides = true;
  // Names of child nodes whose details this coarse geometry represents: it is shown only while at least one of them is
  // shown coarsely (docs/cell-files.md, "Detail levels"). Empty: ordinary geometry, shown with its node.
  std::vector<std::string> stands_for;
  int line = 0;  // where it stands in its file
  int column = 0;
};

}  // namespace cellmirror
