#include "rt_core/geometry/mesh_tree.hpp"

#include <numeric>
#include <utility>

#include "rt_core/geometry/tree_build.hpp"

namespace cellmirror::geometry {

namespace {

// Union-find with path halving.
std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

std::vector<MeshTree::Shell> shells_of(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const TriangleIndices& t : mesh.triangles) {
    for (std::size_t k = 1; k < 3; ++k) parent[root_of(parent, t[k])] = root_of(parent, t[0]);
  }
  constexpr std::uint32_t kNone = ~0U;
  std::vector<std::uint32_t> shell_of_root(mesh.vertices.size(), kNone);
  std::vector<MeshTree::Shell> shells;
  for (const TriangleIndices& t : mesh.triangles) {
    std::uint32_t& shell = shell_of_root[root_of(parent, t[0])];
    if (shell == kNone) {
      shell = static_cast<std::uint32_t>(shells.size());
      shells.emplace_back().extremes.fill(mesh.vertices[t[0]]);
    }
    for (const std::uint32_t v : t) {
      const Eigen::Vector3d& p = mesh.vertices[v];
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3d& least = shells[shell].extremes[2 * static_cast<std::size_t>(axis)];
        Eigen::Vector3d& greatest = shells[shell].extremes[2 * static_cast<std::size_t>(axis) + 1];
        if (p[axis] < least[axis]) least = p;
        if (p[axis] > greatest[axis]) greatest = p;
      }
    }
  }
  return shells;
}

}  // namespace

MeshTree::MeshTree(std::shared_ptr<const TriangleMesh> mesh) : mesh_(std::move(mesh)) {
  BinaryTree tree = build_binary_tree(*mesh_);
  nodes_ = std::move(tree.nodes);
  nodes_.shrink_to_fit();
  original_ = std::move(tree.order);
  depth_ = tree.depth;
  triangles_.reserve(original_.size());
  for (const std::uint32_t i : original_) {
    const TriangleIndices& t = mesh_->triangles[i];
    triangles_.push_back({mesh_->vertices[t[0]], mesh_->vertices[t[1]], mesh_->vertices[t[2]]});
  }
  shells_ = shells_of(*mesh_);
  wide_ = WideTree(*this);
  polytope_ = polytope_of(*mesh_);
}

std::size_t MeshTree::memory_bytes() const {
  return sizeof *this + nodes_.capacity() * sizeof(Node) + triangles_.capacity() * sizeof(Triangle) +
         original_.capacity() * sizeof(std::uint32_t) + shells_.capacity() * sizeof(Shell) + wide_.memory_bytes();
}

}  // namespace cellmirror::geometry
