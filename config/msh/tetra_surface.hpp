// The surface around tetrahedra.
#pragma once

#include <optional>

#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::msh {

// The faces that belong to one tetrahedron only, facing outwards, with the nodes that they use. An error, with the
// place in the mesh's frame, where more than two tetrahedra share a face. O(n log n).
[[nodiscard]] Result<tissue::SurfaceMesh> surface_of(const tissue::TetraMesh& mesh);

}  // namespace cellmirror::msh
