#include "rt_core/geometry/proximity_order.hpp"

#include <cstddef>

namespace cellmirror::geometry {

namespace {

// -1, 0, 1
int compare(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  }
  return 0;
}

}  // namespace

bool comes_first(const Placed& a, const Placed& b) noexcept {
  const bool mesh_a = a.solid.shape == Shape::mesh;
  const bool mesh_b = b.solid.shape == Shape::mesh;
  if (mesh_a != mesh_b) return mesh_a;
  if (mesh_a && a.solid.tree != b.solid.tree) {
    const std::size_t triangles_a = a.solid.tree->triangles().size();
    const std::size_t triangles_b = b.solid.tree->triangles().size();
    if (triangles_a != triangles_b) return triangles_a > triangles_b;
  }
  if (a.solid.shape != b.solid.shape) return a.solid.shape < b.solid.shape;
  for (const int order :
       {compare(a.solid.size, b.solid.size), compare(a.solid.half, b.solid.half),
        compare(a.solid.centre, b.solid.centre), compare(a.X_W.translation(), b.X_W.translation()),
        compare(a.X_W.linear().col(0), b.X_W.linear().col(0)), compare(a.X_W.linear().col(1), b.X_W.linear().col(1))}) {
    if (order != 0) return order < 0;
  }
  return true;
}

}  // namespace cellmirror::geometry
