// Texture coordinates and colours by vertex of a textured mesh, and its triangles in the order of their materials.
// Private to this folder; no OpenGL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/display/internal/surface.hpp"
#include "rt_core/ports/mesh_appearance.hpp"

namespace cellmirror::display {

struct Dress {
  Eigen::Vector2f place = Eigen::Vector2f::Zero();  // in the picture, from its upper left corner
  std::array<std::uint8_t, 4> colour{255, 255, 255, 255};
  bool operator==(const Dress& other) const { return place == other.place && colour == other.colour; }
};
static_assert(sizeof(Dress) == 12);

// The appearance from a file matches its mesh; another one must not be read past its end.
[[nodiscard]] bool sound(const MeshAppearance& look, std::size_t triangles);

// By vertex of the surface. Vertices of which corners have several dresses are doubled: the surface grows and its
// corners name the new ones.
[[nodiscard]] std::vector<Dress> dress(Surface& surface, const MeshAppearance& look);

// The triangles of one material are contiguous.
struct MaterialOrder {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> ends;  // by material, in `triangles`
};
[[nodiscard]] MaterialOrder order_by_material(const MeshAppearance& look);

}  // namespace cellmirror::display
