#include "rt_core/geometry/solid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

struct Core {
  ConvexCore core;
  Vector3d half;      // of the box around core and skin
  double radius = 0;  // of the sphere around core and skin
};

Core core_of(Shape shape, const Vector3d& size) {
  Core out;
  switch (shape) {
    case Shape::box:
      out.core.kind = CoreKind::box;
      out.core.half = 0.5 * size;
      out.half = out.core.half;
      out.radius = out.half.norm();
      break;
    case Shape::cylinder:
      out.core.kind = CoreKind::cylinder;
      out.core.half = {size.x(), size.x(), 0.5 * size.y()};
      out.half = out.core.half;
      out.radius = std::hypot(size.x(), 0.5 * size.y());
      break;
    case Shape::sphere:
      out.core.kind = CoreKind::point;
      out.core.skin = size.x();
      out.half = Vector3d::Constant(size.x());
      out.radius = size.x();
      break;
    case Shape::capsule:
      out.core.kind = CoreKind::segment;
      out.core.half = {0.0, 0.0, 0.5 * size.y()};
      out.core.skin = size.x();
      out.half = Vector3d(size.x(), size.x(), 0.5 * size.y() + size.x());
      out.radius = out.half.z();
      break;
    case Shape::mesh:
      CELLMIRROR_EXPECTS(shape != Shape::mesh);
      break;
  }
  return out;
}

template <typename Map>
void forget_unused(Map& map) {
  std::erase_if(map, [](const auto& entry) { return entry.second.expired(); });
}

}  // namespace

Solid make_primitive(Shape shape, const Vector3d& size) {
  const Core core = core_of(shape, size);
  Solid out;
  out.shape = shape;
  out.size = size;
  out.core = core.core;
  out.half = core.half;
  out.radius = core.radius;
  return out;
}

Solid make_mesh_solid(std::shared_ptr<const TriangleMesh> mesh) {
  Solid out;
  out.shape = Shape::mesh;
  out.tree = std::make_shared<const MeshTree>(std::move(mesh));
  const MeshTree::Node& root = out.tree->nodes()[0];
  out.centre = 0.5 * (root.lower + root.upper);
  out.half = 0.5 * (root.upper - root.lower);
  double squared = 0.0;
  for (const Triangle& triangle : out.tree->triangles()) {
    for (const Vector3d& corner : triangle) squared = std::max(squared, (corner - out.centre).squaredNorm());
  }
  out.radius = std::sqrt(squared);
  return out;
}

std::shared_ptr<const Solid> SolidLibrary::primitive(Shape shape, const Vector3d& size) {
  const PrimitiveKey key{shape, {size.x(), size.y(), size.z()}};
  const std::scoped_lock lock(mutex_);
  if (const auto found = primitives_.find(key); found != primitives_.end()) {
    if (auto solid = found->second.lock()) return solid;
  }
  forget_unused(primitives_);
  auto solid = std::make_shared<const Solid>(make_primitive(shape, size));
  primitives_[key] = solid;
  return solid;
}

// A solid keeps its mesh alive, so an address identifies one mesh as long as its entry can be locked.
std::shared_ptr<const Solid> SolidLibrary::mesh(const std::shared_ptr<const TriangleMesh>& mesh) {
  const std::scoped_lock lock(mutex_);
  if (const auto found = meshes_.find(mesh.get()); found != meshes_.end()) {
    if (auto solid = found->second.lock()) return solid;
  }
  forget_unused(meshes_);
  auto solid = std::make_shared<const Solid>(make_mesh_solid(mesh));
  meshes_[mesh.get()] = solid;
  return solid;
}

}  // namespace cellmirror::geometry
