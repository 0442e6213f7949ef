// The polygons of a mesh file and their appearance as read: before repair, and before textures are decoded. Plain data.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/geometry/triangle_mesh.hpp"
#include "rt_core/ports/mesh_appearance.hpp"

namespace cellmirror {

struct SceneMaterial {
  std::string name;
  std::string picture;                  // file name, verbatim from the mesh file; empty: none, or `embedded`
  std::optional<std::size_t> embedded;  // index in ScenePolygons::embedded
  std::string place;                    // where the picture is named, for messages; may be empty
  std::array<float, 3> rgb{1, 1, 1};    // 0 to 1, sRGB
  bool is_factor = false;               // rgb multiplies textures and colours, as in glTF; otherwise they replace it
};

struct ScenePolygons {
  // m, in the frame G of the geometry, scale applied. Not validated yet: may be NaN.
  std::vector<Eigen::Vector3d> vertices;
  std::vector<geometry::TriangleIndices> triangles;
  // Appearance. By vertex, as in assimp (v upwards); empty if no mesh of the file has it.
  std::vector<Eigen::Vector2f> places;
  std::vector<MeshAppearance::Rgba> colours;
  std::vector<std::uint16_t> materials;  // by triangle, index in `palette`; empty if the appearance is not requested
  std::vector<SceneMaterial> palette;
  std::vector<std::string> embedded;  // the bytes of the pictures that the mesh file holds itself
};

// Beyond that, single precision no longer resolves the pixels of a texture.
inline constexpr float kFarthestPlace = 1e4F;
inline constexpr std::size_t kMostMaterials = 0xFFFF;

}  // namespace cellmirror
