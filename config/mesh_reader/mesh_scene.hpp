// Converts assimp's scene of a mesh file to polygons and their appearance. assimp's types stay in the sources.
#pragma once

#include <Eigen/Core>

#include "config/mesh_message/scene_polygons.hpp"
#include "rt_core/base/result.hpp"

struct aiScene;  // NOLINT(readability-identifier-naming): the name is assimp's

namespace cellmirror {

// All meshes, each as often as nodes show it, each coordinate times `scale`. `with_looks` false: shapes alone.
[[nodiscard]] Result<ScenePolygons> collect_polygons(const aiScene& scene, const Eigen::Vector3d& scale,
                                                     bool with_looks);

}  // namespace cellmirror
