// From what a file says to tetrahedra that can be computed with. Private to this folder.
#pragma once

#include <optional>

#include "config/msh/msh_sections.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::msh {

// The tetrahedra and the nodes that they use, in the file's order; nothing, and errors in `input`, where an id appears
// twice or is unknown, a coordinate is not finite or too large, or a tetrahedron has no volume. Inverted ones are
// turned; `turned` counts them.
[[nodiscard]] std::optional<tissue::TetraMesh> check_tetrahedra(Input& input, const RawMesh& raw, double scale,
                                                                std::size_t& turned);

}  // namespace cellmirror::msh
