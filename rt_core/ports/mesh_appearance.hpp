// Appearance of a mesh: textures and vertex colours. Created by the reader of the mesh file, drawn by drivers/display;
// not used in computations with shapes. Plain data, immutable once shared.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/ports/image.hpp"

namespace cellmirror {

struct MeshMaterial {
  // Repeats beyond its edges. Where its alpha is below 255 the body's own colour shows through. Null: `rgb` alone.
  std::shared_ptr<const Image> picture;
  std::array<float, 3> rgb{1, 1, 1};  // 0 to 1, sRGB; the picture is multiplied by it
};

// Of one geometry::TriangleMesh.
struct MeshAppearance {
  using Rgba = std::array<std::uint8_t, 4>;  // sRGB

  // By corner (3 * triangle + corner): texture coordinates; (0, 0) is the upper left corner of the texture, (1, 1) the
  // lower right one.
  std::vector<Eigen::Vector2f> places;
  std::vector<Rgba> colours;             // by corner, multiplies; empty: white everywhere
  std::vector<std::uint16_t> materials;  // by triangle: index in `palette`
  std::vector<MeshMaterial> palette;
};

}  // namespace cellmirror
