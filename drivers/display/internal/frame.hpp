// What all passes of one pane need. Private to this folder.
#pragma once

#include "drivers/display/internal/gl_api.hpp"
#include "drivers/display/internal/view_transform.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

struct Frame {
  const Scene& scene;
  const ViewTransform& view;
  std::uint32_t camera = 0;  // as Pane::camera
  // Whether an object belongs to the camera of this pane.
  [[nodiscard]] bool own(std::uint32_t of_camera) const { return of_camera != 0 && of_camera == camera; }
};

// The light that casts the shadow comes from here (unit vector towards it, W): from the upper left of a viewer along
// +y, View's default.
[[nodiscard]] inline Eigen::Vector3d towards_light() { return Eigen::Vector3d(-0.42, -0.50, 0.90).normalized(); }

}  // namespace cellmirror::display
