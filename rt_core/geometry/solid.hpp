// A body's shape, prepared for queries: a primitive, or a mesh with its tree. Immutable, shared between threads.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "rt_core/geometry/convex.hpp"
#include "rt_core/geometry/mesh_tree.hpp"
#include "rt_core/geometry/shape.hpp"

namespace cellmirror::geometry {

// In the shape's own frame G. Primitives are solid; a mesh is solid where it is closed, else a surface.
struct Solid {
  Shape shape = Shape::box;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    // as in cellmirror::Geometry, m; meshes: unused
  ConvexCore core;                                   // primitives
  std::shared_ptr<const MeshTree> tree;              // meshes
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of the box around it
  Eigen::Vector3d half = Eigen::Vector3d::Zero();    // half edges of that box
  double radius = 0;                                 // of a sphere about `centre` around it
};

[[nodiscard]] Solid make_primitive(Shape shape, const Eigen::Vector3d& size);  // any shape but mesh
[[nodiscard]] Solid make_mesh_solid(std::shared_ptr<const TriangleMesh> mesh);

// One Solid for equal shapes, and one tree per mesh, for all bodies and threads. Any thread; may wait for another
// thread that builds a tree. Owns nothing.
class SolidLibrary {
 public:
  [[nodiscard]] std::shared_ptr<const Solid> primitive(Shape shape, const Eigen::Vector3d& size);
  [[nodiscard]] std::shared_ptr<const Solid> mesh(const std::shared_ptr<const TriangleMesh>& mesh);

 private:
  using PrimitiveKey = std::pair<Shape, std::array<double, 3>>;

  std::mutex mutex_;
  std::map<PrimitiveKey, std::weak_ptr<const Solid>> primitives_;
  std::map<const TriangleMesh*, std::weak_ptr<const Solid>> meshes_;
};

}  // namespace cellmirror::geometry
