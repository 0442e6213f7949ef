#include "rt_core/scene/bounds.hpp"

#include <utility>

namespace cellmirror::scene {

namespace {

Box about_origin(double x, double y, double z) { return {Eigen::Vector3d(-x, -y, -z), Eigen::Vector3d(x, y, z)}; }

Box of_mesh(const geometry::TriangleMesh& mesh) {
  Box box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

}  // namespace

Box BoundsOfGeometry::of(const Geometry& geometry) {
  const Eigen::Vector3d& size = geometry.size;
  switch (geometry.shape) {
    case Shape::box:
      return about_origin(0.5 * size.x(), 0.5 * size.y(), 0.5 * size.z());
    case Shape::cylinder:
      return about_origin(size.x(), size.x(), 0.5 * size.y());
    case Shape::sphere:
      return about_origin(size.x(), size.x(), size.x());
    case Shape::capsule:
      return about_origin(size.x(), size.x(), size.x() + 0.5 * size.y());
    case Shape::mesh:
      break;
  }
  if (geometry.mesh == nullptr) return {};
  Known& known = meshes_[geometry.mesh.get()];
  // An address may belong to another mesh than before.
  if (known.mesh.lock() != geometry.mesh) known = {geometry.mesh, of_mesh(*geometry.mesh)};
  return known.box;
}

void BoundsOfGeometry::forget_unused() {
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.mesh.expired(); });
}

Box moved(const Pose& X_WG, const Box& box_G) {
  if (box_G.isEmpty() || !X_WG.matrix().allFinite()) return {};
  const Eigen::Vector3d centre = X_WG * box_G.center();
  const Eigen::Vector3d half = X_WG.linear().cwiseAbs() * (0.5 * box_G.sizes());
  return {centre - half, centre + half};
}

}  // namespace cellmirror::scene
