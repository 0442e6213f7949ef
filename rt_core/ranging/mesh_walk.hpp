// The nearest triangle within a cone, by the mesh's tree. Private to this folder.
#pragma once

#include <cstdint>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/mesh_tree.hpp"
#include "rt_core/ranging/cone_section.hpp"

namespace cellmirror::ranging {

// `triangle` (in the tree's order): in: first candidate, out: the nearest one.
void nearest_on_mesh(const ConeShape& cone, const geometry::MeshTree& tree, const Pose& X_SG, Nearest& best,
                     std::uint32_t& triangle) noexcept;

}  // namespace cellmirror::ranging
