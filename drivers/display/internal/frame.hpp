// What all passes of one pane need. Private to this folder.
#pragma once

#include "drivers/display/internal/gl_api.hpp"
#include "drivers/display/internal/view_transform.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

struct Frame {
  const Scene& scene;
  const ViewTransform& view;
};

// The light that casts the shadow comes from here (unit vector towards it, W): from the upper left of who looks
// along +y, as View's default does.
[[nodiscard]] inline Eigen::Vector3d towards_light() { return Eigen::Vector3d(-0.42, -0.50, 0.90).normalized(); }

}  // namespace cellmirror::display
