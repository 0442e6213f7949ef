#include "drivers/display/internal/clips.hpp"

#include <algorithm>
#include <span>

#include "rt_core/geometry/shape.hpp"

namespace cellmirror::display {

namespace {

constexpr std::size_t kMostClips = 500;
constexpr std::size_t kMostCorners = 20'000;  // of a clip
constexpr Colour kMetal{0.80F, 0.82F, 0.86F, 1};

}  // namespace

std::shared_ptr<const geometry::TriangleMesh> Clips::mesh_of(const TissueClip& clip) {
  if (clip.vertices == nullptr || clip.triangles == nullptr) return nullptr;
  if (clip.vertices->size() > kMostCorners || clip.triangles->size() > kMostCorners) return nullptr;
  Shape& shape = shapes_[{clip.vertices.get(), clip.triangles.get()}];
  if (shape.mesh != nullptr && shape.vertices.lock() == clip.vertices && shape.triangles.lock() == clip.triangles)
    return shape.mesh;
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (const Eigen::Vector3f& vertex : *clip.vertices) mesh->vertices.push_back(vertex.cast<double>());
  mesh->triangles.assign(clip.triangles->begin(), clip.triangles->end());
  shape = {clip.vertices, clip.triangles, std::move(mesh)};
  return shape.mesh;
}

std::vector<SceneBody> Clips::bodies(const TissueView& view) {
  std::erase_if(shapes_,
                [](const auto& item) { return item.second.vertices.expired() || item.second.triangles.expired(); });
  std::vector<SceneBody> bodies;
  for (const TissueClip& clip : std::span(view.clips).first(std::min(view.clips.size(), kMostClips))) {
    SceneBody body;
    body.shape = cellmirror::Shape::mesh;
    body.mesh = mesh_of(clip);
    body.X_WG = clip.X_WC;
    body.rgba = kMetal;
    body.casts_shadow = false;
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace cellmirror::display
