// Fills a closed surface with a body-centred cubic lattice of tetrahedra: all of one shape and nearly regular, so that
// the stable time step does not depend on the surface. Boundary tetrahedra reach over the surface; only their part
// inside is material. Fuchs 1998; Labelle, Shewchuk 2007 for the lattice.
#pragma once

#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/tissue/body/rest_mesh.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

inline constexpr std::size_t kMostLatticeNodes = 1'000'000;
inline constexpr std::size_t kMostElements =
    200'000;  // of one object; a step of a millisecond has room for some 20,000

// `size`: edge of the lattice's cubes, m. `name` for messages. Errors: the surface is open or empty, thinner than the
// lattice everywhere, or too large for the size. A surface that is inside out or crosses itself is taken for what it
// encloses. In the frame of the surface.
[[nodiscard]] Result<RestMesh> fill_with_lattice(const std::string& name, const SurfaceMesh& surface, double size);

}  // namespace cellmirror::tissue
