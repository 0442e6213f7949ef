// Extent of the drawn scene, and the resulting clipping planes: the depth buffer divides what lies between them, evenly
// in parallel views and mostly close to the nearer one in others. Private to this folder.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "drivers/display/internal/body_pass.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

using Box = Eigen::AlignedBox3d;  // m, W; may be empty

// Of bodies and marks, without the floor. What is not finite or is too far away to be drawn does not count.
[[nodiscard]] Box reach_of(const Scene& scene, std::span<const DrawnBody> bodies);

// The same eye with its far plane not beyond the reach. Then, not in parallel views, the near plane is at least 1/5000
// of the way there, but never put farther than 10 mm: a body far away costs precision and hides nothing.
[[nodiscard]] Eye bounded_by(const Box& reach, Eye eye);

}  // namespace cellmirror::display
