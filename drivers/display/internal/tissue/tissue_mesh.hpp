// A deforming surface in the memory of the graphics system: triangles and colours are uploaded when its topology
// changes, positions, normals and burns with each view. Private to this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "drivers/display/internal/gl_api.hpp"
#include "drivers/display/internal/texture_store.hpp"
#include "drivers/display/internal/tissue/tissue_vertices.hpp"

namespace cellmirror::display {

class TissueMesh {
 public:
  explicit TissueMesh(const GlApi& gl) : gl_(gl) {}
  ~TissueMesh();
  TissueMesh(const TissueMesh&) = delete;
  TissueMesh& operator=(const TissueMesh&) = delete;

  // False: it cannot be drawn as it is.
  bool update(const TissueSurface& surface);
  // The first picture of its appearance; null where it has none, or no texture coordinates.
  const Texture* texture(TextureStore& textures);
  [[nodiscard]] const std::array<float, 3>& material() const { return material_; }

  // Draw what is bound to attributes 0 (position), 1 (normal and burn), 2 (place in the texture), 3 (colour).
  void draw_skin() const;
  void draw_cut_faces() const;
  void draw_edges();

  [[nodiscard]] bool closed() const { return closed_; }
  [[nodiscard]] bool has_cut_faces() const { return triangles_.corners.size() > triangles_.skin_corners; }
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }  // W
  [[nodiscard]] BoundingSphere sphere() const;                                 // W
  [[nodiscard]] GLuint array() const { return array_; }
  [[nodiscard]] GLsizei corners() const { return static_cast<GLsizei>(triangles_.corners.size()); }
  [[nodiscard]] std::uint64_t topology_uploads() const { return topology_uploads_; }

 private:
  bool take_topology(const std::shared_ptr<const TissueTopology>& topology);
  void upload_topology();
  void make_arrays();
  void draw(std::size_t first, std::size_t end) const;

  const GlApi& gl_;
  std::shared_ptr<const TissueTopology> topology_;  // kept, so that no other one gets its address
  std::shared_ptr<const MeshAppearance> look_;
  std::shared_ptr<const Texture> texture_;
  std::array<float, 3> material_{1, 1, 1};
  TissueTriangles triangles_;
  std::vector<TissueVertex> vertices_;
  bool closed_ = false;
  std::size_t uploaded_ = 0;  // vertices that there were when the topology was uploaded; 0: it is not
  Eigen::AlignedBox3d bounds_;
  std::uint64_t topology_uploads_ = 0;
  GLuint array_ = 0;
  GLuint edge_array_ = 0;
  GLuint vertex_buffer_ = 0;
  GLuint coat_buffer_ = 0;
  GLuint index_buffer_ = 0;
  GLuint edge_buffer_ = 0;
  GLsizei edge_ends_ = 0;  // 0: not made yet
};

}  // namespace cellmirror::display
