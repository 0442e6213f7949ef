// Appearance of a mesh: textures and colours of its file, mapped to the triangles after repair. Private to this folder.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/mesh_message/scene_polygons.hpp"
#include "config/picture_library.hpp"

namespace cellmirror {

// Input and output of parse_mesh() for the appearance.
struct AppearanceRequest {
  // Text that the mesh names beside itself (MTL), a picture by its name in the mesh, and one by its bytes.
  std::function<Result<std::string>(const std::string& name)> text;
  std::function<Result<Picture>(const std::string& name)> picture;
  std::function<Result<Picture>(std::string_view bytes)> embedded;

  std::shared_ptr<const MeshAppearance> look;  // null: there is nothing to show but the shape
  std::vector<Error> left_out;                 // what could not be had, at most kMostLeftOut
  static constexpr std::size_t kMostLeftOut = 16;
};

// `bytes`: of the mesh file.
void name_obj_pictures(std::string_view bytes, AppearanceRequest& request, ScenePolygons& polygons);
// For formats in which the names of pictures are URIs.
void decode_picture_names(ScenePolygons& polygons);

// Loads what the used part of the palette names, each picture once. Empty where no triangle shows a picture and no
// vertex has a colour.
[[nodiscard]] std::optional<std::vector<MeshMaterial>> load_palette(const ScenePolygons& polygons,
                                                                    AppearanceRequest& request);

// `from`: the polygons as they were before repair; `origins` as make_mesh() gives them.
[[nodiscard]] MeshAppearance lay_over(const geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& origins,
                                      const ScenePolygons& from, std::vector<MeshMaterial> palette);

}  // namespace cellmirror
