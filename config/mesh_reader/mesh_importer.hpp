// A mesh file as assimp reads it, from memory. assimp's types stay in the sources.
#pragma once

#include "config/mesh_message/mesh_message.hpp"

namespace cellmirror {

// Polygons in the frame G as config/mesh_file.hpp describes it. May end the process by any signal, or throw: assimp
// believes some numbers in files.
[[nodiscard]] Result<ScenePolygons> import_mesh(const MeshRequest& request);

}  // namespace cellmirror
