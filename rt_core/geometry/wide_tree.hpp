// The tree of a mesh again, in the form that walks of two trees are fastest with: up to eight children a node, lying
// side by side in single precision for the processor's vector instructions. Every child, down to the single triangle,
// has a box along the mesh's axes and a slab along its own mean normal, which is thin where the surface is flat. Boxes
// and slabs are rounded outwards: single precision costs nothing in exactness, a bound is only a little lower.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cellmirror::geometry {

class MeshTree;

struct alignas(32) WideNode {
  static constexpr std::size_t kWidth = 8;
  using Lanes = std::array<float, kWidth>;

  std::array<Lanes, 3> centre{};  // m, from WideTree::origin()
  std::array<Lanes, 3> half{};    // m
  std::array<Lanes, 3> normal{};  // not longer than 1; zero where the surface has no common direction
  Lanes middle{};                 // of the slab along the normal, m from origin()
  Lanes thick{};                  // half the slab's thickness, m
  std::array<std::uint32_t, kWidth> child{};
};

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
