// The bodies of a compiled cell: what every node carries that can collide.
#pragma once

#include <string>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::collision {

struct CollectedBodies {
  std::vector<Body> bodies;         // in the order of their nodes; each with at least one part
  std::vector<std::string> doubts;  // geometry that collides but has no shape to test, in words
  std::size_t triangles = 0;
};

[[nodiscard]] CollectedBodies collect_bodies(const CompiledCell& cell, geometry::SolidLibrary& solids);

}  // namespace cellmirror::collision
