// Cuts polygons of mesh files into triangles. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror {

inline constexpr std::size_t kMostCorners = 2048;  // of a polygon that is cut with care; a fan where it has more

// Appends corners.size() - 2 triangles that run round as the polygon does. Convex and concave polygons, also not quite
// plane ones; where corners cannot be cut off without overlap (the polygon crosses itself) the rest becomes a fan, so
// that nothing is left out. Corners are indices of `vertices`. Source: ear clipping, Meisters 1975.
void cut_polygon(std::span<const std::uint32_t> corners, std::span<const Eigen::Vector3d> vertices,
                 std::vector<geometry::TriangleIndices>& triangles);

}  // namespace cellmirror
