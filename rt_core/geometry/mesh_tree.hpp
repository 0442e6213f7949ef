// A binary tree of axis-parallel boxes over the triangles of a mesh, in the mesh's own frame. Immutable, shared by
// every body with that mesh; collision and ranging walk the same tree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rt_core/geometry/polytope.hpp"
#include "rt_core/geometry/triangle.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"
#include "rt_core/geometry/wide_tree.hpp"

namespace cellmirror::geometry {

class MeshTree {
 public:
  static constexpr std::uint32_t kTrianglesInLeaf = 4;  // at most
  static constexpr int kMaxDepth = 64;                  // levels, whatever the mesh
  static constexpr std::size_t kMaxTriangles = std::size_t{1} << 26U;

  // A part of the mesh connected by common vertices. If the surfaces do not touch, it is wholly inside another body or
  // wholly outside.
  struct Shell {
    std::array<Eigen::Vector3d, 6> extremes;  // m, vertices: least x, greatest x, least y, ...
  };

  // Depth first: the left child of an inner node follows it directly.
  struct Node {
    Eigen::Vector3d lower;  // m, corners of the box
    Eigen::Vector3d upper;
    std::uint32_t right = 0;  // inner node: index of the right child. Leaf: first triangle, in the tree's own order
    std::uint32_t count = 0;  // 0: inner node. Else the leaf's triangles
    [[nodiscard]] bool leaf() const { return count > 0; }
  };

  // Of a mesh with at least one triangle, and at most kMaxTriangles. O(n log n), surface area heuristic. Not for the
  // tick.
  explicit MeshTree(std::shared_ptr<const TriangleMesh> mesh);

  [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }              // [0]: the root
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }  // in the tree's order
  // Index in mesh().triangles of a triangle of the tree.
  [[nodiscard]] std::uint32_t original(std::uint32_t triangle) const { return original_[triangle]; }
  [[nodiscard]] int depth() const { return depth_; }                       // levels, at most kMaxDepth
  [[nodiscard]] std::span<const Shell> shells() const { return shells_; }  // at least one
  [[nodiscard]] const WideTree& wide() const { return wide_; }
  // Of convex meshes that are not too large; else null.
  [[nodiscard]] const Polytope* polytope() const { return polytope_ ? &*polytope_ : nullptr; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::shared_ptr<const TriangleMesh> mesh_;
  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> original_;
  std::vector<Shell> shells_;
  WideTree wide_;
  std::optional<Polytope> polytope_;
  int depth_ = 0;
};

}  // namespace cellmirror::geometry
