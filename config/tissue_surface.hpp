// From a mesh to the surface of a deformable object. Private to this folder.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>

#include "config/mesh_library.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror {

// Refused, with a place in the mesh: surfaces that are open, cross themselves, have too many triangles, or are no
// object of 0.1 mm to 10 m. O(n log n).
[[nodiscard]] Result<void> check_tissue_surface(const std::shared_ptr<const geometry::TriangleMesh>& mesh);

// "it is 100 m long, but ..." where the box is not around an object of 0.1 mm to 10 m.
[[nodiscard]] Result<void> check_object_size(const Eigen::AlignedBox3d& box);

struct TissueSurfaceMesh {
  tissue::SurfaceMesh surface;
  std::shared_ptr<const MeshAppearance> look;  // one material, with the picture; null: none
  std::size_t without_picture = 0;             // triangles that show another picture of the mesh
};
// Of a mesh that was read with its appearance. Vertices are divided where texture coordinates differ between triangles.
[[nodiscard]] TissueSurfaceMesh tissue_surface(const geometry::TriangleMesh& mesh, const MeshAppearance* look);

// "[0.1, 0.2, 0.3] m"
[[nodiscard]] std::string place_text(const Eigen::Vector3d& p);

}  // namespace cellmirror
