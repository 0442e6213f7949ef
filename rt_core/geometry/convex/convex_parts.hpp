// Approximate convex decomposition: a few convex meshes that together contain a mesh. Not for the tick: takes tenths of
// a second for a mesh of some thousand triangles. Any thread. Source: hierarchical decomposition by cutting planes, as
// in Lien, Amato 2007.
#pragma once

#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::geometry {

struct PartsSettings {
  double concavity = 0.02;  // of the mesh's size: how far pieces may stand off the surface, where the count allows it
  std::size_t most = 24;    // pieces
};

// Conservative: every point of the mesh, and of its inside where it is closed, lies in some piece (up to 1e-10 of its
// size). Refused: flat meshes (see convex_hull()).
[[nodiscard]] Result<std::vector<TriangleMesh>> convex_parts(const TriangleMesh& mesh,
                                                             const PartsSettings& settings = {});

}  // namespace cellmirror::geometry
