// Living tissue for tests, the benchmark and the gallery of drivers/display.
#pragma once

#include <memory>

#include "rt_core/ports/scene.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::display {

// A rounded, closed body about the origin, about 2 * around * across triangles with shared vertices, a little red.
[[nodiscard]] std::shared_ptr<const TissueTopology> organ_topology(unsigned around, unsigned across);
// Its shape at a phase (rad) of its motion; `topology` must be of the same numbers.
[[nodiscard]] TissueSurface organ(std::shared_ptr<const TissueTopology> topology, unsigned around, unsigned across,
                                  double radius_m, double phase);
// A sheet of 2 m x 2 m, of 2 * cells * cells triangles, that shows its front to who looks along +y; grey, dull.
[[nodiscard]] TissueSurface tissue_sheet(unsigned cells = 8);

// Nodes of a cubic lattice within the organ of organ(), some of them in contact, the lowest fixed.
[[nodiscard]] TissueNetwork organ_network(double radius_m, double edge_m);

// The scene with these as its tissue.
[[nodiscard]] Scene with_tissue(TissueView view);

// Of everything there is: an organ with a burnt spot and a cut, clips, a pool, blood, water and smoke.
[[nodiscard]] Scene tissue_gallery_scene();
[[nodiscard]] Pane tissue_gallery_pane();

}  // namespace cellmirror::display
