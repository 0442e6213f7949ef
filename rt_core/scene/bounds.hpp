// How far bodies reach.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <unordered_map>

#include "rt_core/base/pose.hpp"
#include "rt_core/cell/geometry.hpp"

namespace cellmirror::scene {

using Box = Eigen::AlignedBox3d;  // m, axis-aligned; may be empty

// Bounds of geometries in their own frame G. Meshes are remembered as long as they are in use.
class BoundsOfGeometry {
 public:
  [[nodiscard]] Box of(const Geometry& geometry);
  void forget_unused();

 private:
  struct Known {
    std::weak_ptr<const geometry::TriangleMesh> mesh;
    Box box;
  };
  std::unordered_map<const geometry::TriangleMesh*, Known> meshes_;
};

// An axis-aligned box about a box that lies in another frame; empty where the pose is not finite.
[[nodiscard]] Box moved(const Pose& X_WG, const Box& box_G);

}  // namespace cellmirror::scene
