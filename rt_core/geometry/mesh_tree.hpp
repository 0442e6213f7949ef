// A binary tree of axis-parallel boxes over the triangles of a mesh, in the mesh's own frame. Immutable, shared by
// every body with that mesh; collision and ranging walk the same tree.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rt_core/geometry/triangle.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::geometry {

class MeshTree {
 public:
  static constexpr std::uint32_t kTrianglesInLeaf = 4;  // at most

  // Depth first: the left child of an inner node stands right behind it.
  struct Node {
    Eigen::Vector3d lower;  // m, corners of the box
    Eigen::Vector3d upper;
    std::uint32_t right = 0;  // inner node: index of the right child. Leaf: first triangle, in the tree's own order
    std::uint32_t count = 0;  // 0: inner node. Else the leaf's triangles
    [[nodiscard]] bool leaf() const { return count > 0; }
  };

  // Of a mesh with at least one triangle. O(n log n), surface area heuristic. Not for the tick.
  explicit MeshTree(std::shared_ptr<const TriangleMesh> mesh);

  [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }              // [0]: the root
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }  // in the tree's order
  // Index in mesh().triangles of a triangle of the tree.
  [[nodiscard]] std::uint32_t original(std::uint32_t triangle) const { return original_[triangle]; }
  [[nodiscard]] int depth() const { return depth_; }  // levels, at most 64
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::shared_ptr<const TriangleMesh> mesh_;
  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> original_;
  int depth_ = 0;
};

}  // namespace cellmirror::geometry
