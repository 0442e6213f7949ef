// Scenes for tests, the benchmark and the gallery of drivers/display.
#pragma once

#include <memory>

#include "rt_core/geometry/triangle_mesh.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

[[nodiscard]] Pose at(double x, double y, double z, double yaw = 0);
// Object numbers count from 1 in the order of adding.
SceneBody& add_box(Scene& scene, const Eigen::Vector3d& edges, const Pose& X_WG);
SceneBody& add_mesh(Scene& scene, std::shared_ptr<const geometry::TriangleMesh> mesh, const Pose& X_WG);

// About the origin, looked at along +y from slightly above.
[[nodiscard]] Pane pane_looking_at(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& lookpoint,
                                   double opening_angle = 0.7);

// A torus that lies in the xy plane, of 2 * around * across triangles.
[[nodiscard]] std::shared_ptr<const geometry::TriangleMesh> torus(double radius, double thickness, unsigned around,
                                                                  unsigned across);
// A cell with two arms, a table, a cabinet, and one of each thing that can be drawn.
[[nodiscard]] Scene gallery_scene();
[[nodiscard]] Pane gallery_pane();

}  // namespace cellmirror::display
