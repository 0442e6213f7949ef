// Builds the binary tree of a mesh. Used by mesh_tree.cpp alone.
#pragma once

#include <cstdint>
#include <vector>

#include "rt_core/geometry/mesh_tree.hpp"

namespace cellmirror::geometry {

struct BinaryTree {
  std::vector<MeshTree::Node> nodes;
  std::vector<std::uint32_t> order;  // the mesh's triangles in the order of the leaves
  int depth = 0;
};

// Binned surface area heuristic (Wald 2007): cheap to build and near the full heuristic in quality. Where it would make
// the tree deeper than MeshTree::kMaxDepth, or finds nothing to split (equal centres), it halves by number.
[[nodiscard]] BinaryTree build_binary_tree(const TriangleMesh& mesh);

}  // namespace cellmirror::geometry
