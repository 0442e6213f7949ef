// The polygons of a mesh file and what they look like, as the reader of meshes finds them: before repair, and before
// any picture is decoded. Plain data.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/geometry/triangle_mesh.hpp"
#include "rt_core/ports/mesh_look.hpp"

namespace cellmirror {

struct SceneMaterial {
  std::string name;
  std::string picture;                  // name of a file as it stands in the mesh file; empty: none, or `embedded`
  std::optional<std::size_t> embedded;  // index in ScenePolygons::embedded
  std::string place;                    // where the picture is named, for messages; may be empty
  std::array<float, 3> rgb{1, 1, 1};    // 0 to 1, sRGB
  bool is_factor = false;               // rgb multiplies pictures and colours, as in glTF; elsewhere they stand for it
};

struct ScenePolygons {
  // m, in the frame G of the geometry, scale applied. Not looked at yet: may be no numbers.
  std::vector<Eigen::Vector3d> vertices;
  std::vector<geometry::TriangleIndices> triangles;
  // What they look like. By vertex, as assimp has it (v goes up); empty where no mesh of the file has such.
  std::vector<Eigen::Vector2f> places;
  std::vector<MeshLook::Rgba> colours;
  std::vector<std::uint16_t> materials;  // by triangle, index in `palette`; empty where looks are not wanted
  std::vector<SceneMaterial> palette;
  std::vector<std::string> embedded;  // the bytes of the pictures that the mesh file holds itself
};

// Beyond that, single precision no longer tells the pixels of a picture apart.
inline constexpr float kFarthestPlace = 1e4F;
inline constexpr std::size_t kMostMaterials = 0xFFFF;

}  // namespace cellmirror
