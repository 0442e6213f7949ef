// In which order the two bodies of a query are computed.
#pragma once

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror::geometry {

struct Placed {
  const Solid& solid;
  const Pose& X_W;
};

// It must not depend on which of them was named first, or rounding and ties would make the answer depend on it: meshes
// first, then by size, shape and place.
[[nodiscard]] bool comes_first(const Placed& a, const Placed& b) noexcept;

}  // namespace cellmirror::geometry
