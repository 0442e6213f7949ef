// Deforming surfaces, clips and fluids for clients that draw the cell themselves (docs/monitor-page.md): what stays as
// it is while nothing is cut or clipped, and what moves. Little-endian; every part begins at a multiple of 4 bytes.
// Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app {

// Of a message; what is beyond is left out.
inline constexpr std::size_t kMostTissueSurfaces = 64;
inline constexpr std::size_t kMostTissueVertices = 200'000;
inline constexpr std::size_t kMostTissueTriangles = 400'000;
inline constexpr std::size_t kMostTissueClips = 200;
inline constexpr std::size_t kMostTissueParticles = 1000;

// Which surfaces and clips there are. As long as it is equal, the shape is the same.
struct TissueShapeKey {
  std::vector<std::shared_ptr<const void>> parts;  // held, so that no other part gets the same address
  std::vector<std::size_t> vertices;               // by surface
  bool operator==(const TissueShapeKey&) const = default;
};
[[nodiscard]] TissueShapeKey tissue_shape_key(const TissueView& view);

// "CMT1", u32 `number`, u32 surfaces, u32 clips; then
//   a surface   u32 vertices, u32 triangles, u32 how many of these are skin (the others, behind them, were cut); 3 u32
//   a
//               triangle; 4 bytes a vertex: red, green, blue, 0
//   a clip      u32 vertices, u32 triangles; 3 f32 a vertex; 3 u32 a triangle
// A surface whose parts do not fit together has no vertices.
[[nodiscard]] std::string tissue_shape(const TissueView& view, std::uint32_t number);

// "CMM1", u32 `number` of the shape, u32 surfaces, clips, particles, pools (0 or 1); then
//   a surface   6 f32: a corner of its box and the box's edges; u32 bits (1 shown, 2 wet); by vertex 3 u16: place in
//   the box,
//               0 to 65535; 2 i8: octahedral normal, -127 to 127; u8: burn (0 raw, 127 coagulated, 255 charred)
//   a clip      7 f32: pose as a body's
//   a particle  4 f32: place and radius; u32: 0 blood, 1 smoke, 2 water
//   a pool      7 f32: pose of its middle at level 0; 3 f32: edges and level; u32 colour (red in the lowest byte)
[[nodiscard]] std::string tissue_motion(const TissueView& view, std::uint32_t number);

}  // namespace cellmirror::app
