// Whether a body can be made of a description: what files and commands say is hostile until it is checked here. Private
// to this folder.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

inline constexpr double kLargestCoordinate_m = 1000;

// Figures, counts and indices; all but what only the lattice can say of the surface. An error names the object, the
// place and a remedy.
[[nodiscard]] Result<void> check_description(const ObjectDescription& description);

}  // namespace cellmirror::tissue
