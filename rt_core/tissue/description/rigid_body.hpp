// Rigid bodies of the cell as tissue meets them.
#pragma once

#include <memory>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror::tissue {

struct RigidBodyPose {
  std::uint32_t id = 0;  // the same number from step to step for the same body
  const geometry::Solid* solid = nullptr;
  Pose X_WB = Pose::Identity();
};

}  // namespace cellmirror::tissue
