#include "config/mesh_finish.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace cellmirror {

using geometry::MeshFindings;
using geometry::TriangleMesh;

Result<TriangleMesh> finish_mesh(ScenePolygons polygons, std::string_view bytes, std::string_view extension,
                                 const std::string& name, MeshFindings& findings, AppearanceRequest* looks) {
  std::optional<std::vector<MeshMaterial>> palette;
  if (looks != nullptr) {
    if (extension == ".obj") name_obj_pictures(bytes, *looks, polygons);
    // Those of DAE were decoded by assimp.
    if (extension == ".gltf" || extension == ".glb") decode_picture_names(polygons);
    palette = load_palette(polygons, *looks);
  }
  if (!palette) return geometry::make_mesh(name, std::move(polygons.vertices), std::move(polygons.triangles), findings);
  std::vector<std::uint32_t> origins;
  auto mesh = geometry::make_mesh(name, polygons.vertices, polygons.triangles, findings, &origins);
  if (mesh)
    looks->look = std::make_shared<const MeshAppearance>(lay_over(*mesh, origins, polygons, std::move(*palette)));
  return mesh;
}

}  // namespace cellmirror
