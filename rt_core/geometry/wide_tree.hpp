// The tree of a mesh again, in the form that walks of two trees are fastest with: up to eight children a node, lying
// side by side in single precision for the processor's vector instructions. Every child, down to the single triangle,
// has a box of its own orientation, which is thin where the surface is flat. Boxes are rounded outwards: single
// precision costs nothing in exactness, a bound is only a little lower.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/geometry/wide_node.hpp"

namespace cellmirror::geometry {

class MeshTree;

class WideTree {
 public:
  static constexpr std::uint32_t kTriangle = 1U << 31U;  // flag of a child that is a triangle in the tree's order
  static constexpr std::uint32_t kNone = ~0U;            // an empty place; its box lies far away

  WideTree() = default;
  explicit WideTree(const MeshTree& tree);

  // [0] has one child in place 0: the whole mesh.
  [[nodiscard]] std::span<const WideNode> nodes() const { return nodes_; }
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }  // in the mesh's frame
  [[nodiscard]] double reach() const { return reach_; }                    // m: no vertex is farther from origin()
  [[nodiscard]] std::size_t memory_bytes() const { return nodes_.capacity() * sizeof(WideNode); }

 private:
  std::vector<WideNode> nodes_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double reach_ = 0;
};

}  // namespace cellmirror::geometry
