// From the scene that assimp made of a mesh file to polygons and what they look like. Private to this folder; assimp's
// types stay in the sources.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"
#include "rt_core/ports/mesh_look.hpp"

struct aiScene;  // NOLINT(readability-identifier-naming): the name is assimp's

namespace cellmirror {

struct SceneMaterial {
  std::string name;
  std::string picture;                  // name of a file as it stands in the mesh file; empty: none, or `embedded`
  std::optional<std::size_t> embedded;  // index in ScenePolygons::embedded
  std::string place;                    // where the picture is named, for messages; may be empty
  std::array<float, 3> rgb{1, 1, 1};
  bool is_factor = false;  // rgb multiplies pictures and colours, as in glTF; elsewhere they stand for it
};

struct ScenePolygons {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<geometry::TriangleIndices> triangles;
  // What they look like. By vertex, as assimp has it (v goes up); empty where no mesh of the file has such.
  std::vector<Eigen::Vector2f> places;
  std::vector<MeshLook::Rgba> colours;
  std::vector<std::uint16_t> materials;  // by triangle, index in `palette`; empty where looks are not wanted
  std::vector<SceneMaterial> palette;
  // The bytes of the pictures that the mesh file holds itself: parts of the scene, and gone with it.
  std::vector<std::string_view> embedded;
};

// All meshes, each as often as nodes show it. `with_looks` false: shapes alone.
[[nodiscard]] Result<ScenePolygons> collect_polygons(const aiScene& scene, const Eigen::Vector3d& scale,
                                                     bool with_looks);

}  // namespace cellmirror
