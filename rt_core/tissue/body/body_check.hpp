// Whether a body can be made of a description: what files and commands say is hostile until it is checked here. Private
// to this folder.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

inline constexpr double kLargestCoordinate_m = 1000;
// Volume of a tetrahedron over that of a regular one with its longest edge. A flatter one swings so fast that a stable
// step would need many times its mass.
inline constexpr double kLeastQuality = 0.001;

// Figures, counts and indices; all but what only the lattice can say of the surface. An error names the object, the
// place and a remedy.
[[nodiscard]] Result<void> check_description(const ObjectDescription& description);

}  // namespace cellmirror::tissue
