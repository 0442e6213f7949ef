// Whether a mesh crosses itself. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror {

struct SelfCrossings {
  std::size_t pairs = 0;                            // of triangles that cross; counting ends at kMostCrossings
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // of one of them, frame of the mesh
  bool complete = true;  // false: so many triangles lie close together that not all were compared
};
inline constexpr std::size_t kMostCrossings = 10'000;
inline constexpr std::size_t kMostComparisons = 50'000'000;

// An edge of one triangle passes through another one, or through its edge, and shares no corner with it. Corners that
// only touch, within 1e-9 of the mesh's size, do not count; parts that lie flush against each other usually do, by
// their edges. O(n log n) for meshes that do not cross.
[[nodiscard]] SelfCrossings find_self_crossings(const std::shared_ptr<const geometry::TriangleMesh>& mesh);

}  // namespace cellmirror
