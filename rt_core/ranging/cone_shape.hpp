// The query behind nearest_in_cone(), for callers with many solids and one cone. Private to this folder.
#pragma once

#include <cstdint>
#include <optional>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/ranging/cone.hpp"
#include "rt_core/ranging/cone_section.hpp"

namespace cellmirror::ranging {

// None where the angles are not those of a cone.
[[nodiscard]] std::optional<ConeShape> cone_shape(const Cone& cone) noexcept;

// Improves `best` if a point of the solid is nearer. `triangle`: of a mesh, in the tree's order; in: first candidate
// (any number), out: the nearest one.
void nearest_on_solid(const geometry::Solid& solid, const Pose& X_SG, const ConeShape& cone, Nearest& best,
                      std::uint32_t& triangle) noexcept;

}  // namespace cellmirror::ranging
