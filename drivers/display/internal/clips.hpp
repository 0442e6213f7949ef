// Clips that were placed, as bodies of the scene: pieces of metal. Private to this folder; no OpenGL.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "rt_core/geometry/triangle_mesh.hpp"
#include "rt_core/ports/scene.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::display {

class Clips {
 public:
  // Bounded in number. They have no object number, and no shadow: they lie on what has one.
  [[nodiscard]] std::vector<SceneBody> bodies(const TissueView& view);

 private:
  using Vertices = std::shared_ptr<const std::vector<Eigen::Vector3f>>;
  using Triangles = std::shared_ptr<const std::vector<std::array<std::uint32_t, 3>>>;
  struct Shape {
    std::weak_ptr<const std::vector<Eigen::Vector3f>> vertices;  // an address may belong to another one than before
    std::weak_ptr<const std::vector<std::array<std::uint32_t, 3>>> triangles;
    std::shared_ptr<const geometry::TriangleMesh> mesh;  // the same for clips that share their shape
  };

  [[nodiscard]] std::shared_ptr<const geometry::TriangleMesh> mesh_of(const TissueClip& clip);

  std::map<std::pair<const void*, const void*>, Shape> shapes_;
};

}  // namespace cellmirror::display
