// Deforming surfaces as the graphics system takes them: what changes with each picture apart from what stays. Private
// to this folder; no OpenGL.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/display/internal/dress.hpp"
#include "drivers/display/internal/surface.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::display {

// 20 bytes: they are uploaded with each picture.
struct TissueVertex {
  std::array<float, 3> position{};       // m, W
  std::array<std::int16_t, 3> normal{};  // -1 to 1
  std::int16_t burn = 0;                 // 0 to 1: half of TissueSurface::burn
};
static_assert(sizeof(TissueVertex) == 20);

struct TissueTriangles {
  std::vector<Corner> corners;   // three per triangle; those that were there from the start come first
  std::size_t skin_corners = 0;  // of them; the others belong to faces that were cut
  std::vector<bool> used;        // by vertex, as far as there are any: a surface that was cut has vertices to spare
};

inline constexpr std::size_t kMostTissueTriangles = 4'000'000;

// Nothing where there are none, or too many.
[[nodiscard]] std::optional<TissueTriangles> divide_by_cut(const TissueTopology& topology);
// Each edge runs as often one way as the other: nobody outside sees a back face.
[[nodiscard]] bool is_closed(const TissueTriangles& triangles);
// Ends of the edges, each edge once.
[[nodiscard]] std::vector<Corner> edges_of(const TissueTriangles& triangles);
// Texture coordinates and colour by vertex; attributes whose count is not that of the vertices are taken for absent.
[[nodiscard]] std::vector<Dress> coat_of(const TissueTopology& topology, std::size_t vertices);
// The bounds of the vertices in use, W. Nothing where the position of one is not finite or far away, where one is not
// there, or where the normals are not as many.
[[nodiscard]] std::optional<Eigen::AlignedBox3d> pack_vertices(const TissueSurface& surface,
                                                               const TissueTriangles& triangles,
                                                               std::vector<TissueVertex>& vertices);

}  // namespace cellmirror::display
