// Triangles for the graphics system: with normals, and with the edges of a wireframe. Private to this folder; no
// OpenGL.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::display {

struct Vertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
};
static_assert(sizeof(Vertex) == 6 * sizeof(float));

using Corner = std::uint32_t;

struct Surface {
  std::vector<Vertex> vertices;
  std::vector<Corner> corners;  // three per triangle, counter-clockwise from outside
};

// An edge of a wireframe and its adjacent triangles, which determine its visibility; the same one twice at open edges.
struct FeatureEdge {
  std::array<std::uint32_t, 2> vertices{};  // of the mesh
  std::array<std::uint32_t, 2> triangles{};
};

struct BoundingSphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};

// Faces that meet at less than this angle share their normals (Gouraud); machine parts keep their edges.
inline constexpr double kCreaseAngle = 0.5235987755982988;  // rad, 30 degrees

[[nodiscard]] std::vector<Eigen::Vector3f> face_normals(const geometry::TriangleMesh& mesh);
[[nodiscard]] Surface smooth_surface(const geometry::TriangleMesh& mesh);
// Three vertices a triangle, each with the normal of its face.
[[nodiscard]] Surface flat_surface(const geometry::TriangleMesh& mesh);
// Without those between faces that are nearly in one plane.
[[nodiscard]] std::vector<FeatureEdge> feature_edges(const geometry::TriangleMesh& mesh);
[[nodiscard]] BoundingSphere bounding_sphere(const geometry::TriangleMesh& mesh);

}  // namespace cellmirror::display
