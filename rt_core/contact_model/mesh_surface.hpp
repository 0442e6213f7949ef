// Adjacency of a mesh's triangles and the surface at their edges. Distinguishes a true nearest point from the nearest
// point of a single triangle, and provides normals that are continuous across facets. Immutable.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt_core/geometry/mesh_tree.hpp"

namespace cellmirror::contact_model {

// Facets that meet at less than this approximate one smooth surface.
inline constexpr double kSmoothAngle = 0.53;  // rad

enum class FeatureKind : std::uint8_t { face, edge, corner };

// Where on a triangle a point lies.
struct Feature {
  FeatureKind kind = FeatureKind::face;
  std::uint32_t triangle = 0;                         // in the order of the tree
  std::uint8_t index = 0;                             // edge i runs from corner i to the next one
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();  // of the corners
};

// All vectors in the mesh's frame.
class MeshSurface {
 public:
  // Keeps the tree by reference. O(n log n).
  explicit MeshSurface(const geometry::MeshTree& tree);

  // `p`: on the triangle, m.
  [[nodiscard]] Feature feature(std::uint32_t triangle, const Eigen::Vector3d& p) const;
  // Whether no neighbouring triangle is nearer to something in the direction `d` (unit vector) from the feature.
  [[nodiscard]] bool nearest_around(const Feature& feature, const Eigen::Vector3d& p, const Eigen::Vector3d& d) const;
  // The normal of the smooth surface that the facets approximate; false: there is none at this edge or corner.
  [[nodiscard]] bool smooth_normal(const Feature& feature, Eigen::Vector3d& normal) const;
  [[nodiscard]] const Eigen::Vector3d& facet_normal(std::uint32_t triangle) const { return facets_[triangle].normal; }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  struct Facet {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    std::array<Eigen::Vector3d, 3> corner_normals;
    std::array<std::uint32_t, 3> across{kNone, kNone, kNone};  // by edge
    std::array<std::uint32_t, 3> corners{};
    std::uint8_t sharp_edges = 0;  // bit i: edge i
  };

  void join_edges();
  void collect_rings();
  void blend_normals();

  const geometry::MeshTree& tree_;
  std::vector<Facet> facets_;               // in the order of the tree
  std::vector<std::uint32_t> ring_begin_;   // by vertex of the mesh: into ring_, one more than vertices
  std::vector<std::uint32_t> ring_;         // facets around a vertex
  std::vector<std::uint8_t> sharp_corner_;  // by vertex: a sharp or open edge ends there
};

}  // namespace cellmirror::contact_model
