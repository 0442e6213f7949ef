// Rays of Embree: an independent reference for ranging, and what it is compared with. Single precision.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror {

class RayFan {
 public:
  RayFan();
  ~RayFan();
  RayFan(const RayFan&) = delete;
  RayFan& operator=(const RayFan&) = delete;

  // An instance of the mesh; equal pointers share their tree. The answer is its number, counting from 0.
  std::size_t add(const std::shared_ptr<const geometry::TriangleMesh>& mesh);
  void place(std::size_t instance, const Pose& X_WG);
  void commit();  // after the last place()

  // Along one ray in the world, m.
  [[nodiscard]] std::optional<double> along(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                            double range) const;
  // The nearest hit of `rays` rays that are spread evenly over the cone; rounded up to packets of eight.
  [[nodiscard]] std::optional<double> nearest(const Pose& X_WS, double half_angle, double range,
                                              std::size_t rays) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace cellmirror
