// Converts the reader's result to the mesh and its appearance. Private to this folder; allocates, any thread.
#pragma once

#include <string>
#include <string_view>

#include "config/mesh_appearance.hpp"
#include "config/mesh_message/scene_polygons.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror {

// Second part of parse_mesh(). `polygons` from decode_mesh_answer(), with appearance if `looks` is not null; `bytes`
// and `extension` of the mesh file.
[[nodiscard]] Result<geometry::TriangleMesh> finish_mesh(ScenePolygons polygons, std::string_view bytes,
                                                         std::string_view extension, const std::string& name,
                                                         geometry::MeshFindings& findings, AppearanceRequest* looks);

}  // namespace cellmirror
