// Whether a point, or a whole body, lies inside of a closed mesh.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/mesh_tree.hpp"

namespace cellmirror::geometry {

// How often the mesh winds around a point: 0 outside, 1 inside; other values where shells overlap or lie inside out. Of
// a closed mesh, in its own frame. A ray is followed through the tree; one too near an edge is replaced by another, and
// after several by the sum of all solid angles (van Oosterom, Strackee 1983), which takes no ray but time in proportion
// to the mesh. On the surface itself either answer may come.
[[nodiscard]] int winding_number(const MeshTree& tree, const Eigen::Vector3d& p) noexcept;

// In the sense of "solid": closed, and the winding number is not 0.
[[nodiscard]] bool contains(const MeshTree& tree, const Eigen::Vector3d& p) noexcept;

// Whether some shell of `inner` lies in `outer`, given that their surfaces do not touch; then `p` (in outer's frame) is
// a vertex of it.
[[nodiscard]] bool contains_a_shell(const MeshTree& outer, const MeshTree& inner, const Pose& X_OuterInner,
                                    Eigen::Vector3d& p) noexcept;

}  // namespace cellmirror::geometry
