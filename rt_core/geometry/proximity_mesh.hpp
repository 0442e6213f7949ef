// Distances between meshes and between a mesh and a primitive: the cases of proximity.hpp that walk trees. Surfaces
// only; proximity.cpp tests containment. Poses must be finite.
#pragma once

#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::geometry {

// Points in A's frame. Ends at the first pair that is at most `enough` apart, m.
[[nodiscard]] Separation mesh_mesh_separation(const MeshTree& a, const MeshTree& b, const Pose& X_AB, double up_to,
                                              double enough, ProximityHint& hint) noexcept;
// Points in the mesh's frame M; p_a is on the mesh.
[[nodiscard]] Separation mesh_primitive_separation(const MeshTree& mesh, const ConvexCore& primitive, const Pose& X_MP,
                                                   double up_to, double enough, ProximityHint& hint) noexcept;

}  // namespace cellmirror::geometry
