// Meshes in the memory of the graphics system: each is uploaded once and kept while it has other owners. Private to
// this folder.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "drivers/display/internal/dress.hpp"
#include "drivers/display/internal/gl_api.hpp"
#include "drivers/display/internal/surface.hpp"
#include "drivers/display/internal/texture_store.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

// Vertices with the triangles over them.
struct Buffers {
  GLuint array = 0;  // vertex array object
  GLuint vertices = 0;
  GLuint indices = 0;
  GLuint dress = 0;                 // of vertices; 0: the mesh has no appearance
  GLsizei count = 0;                // of indices
  std::vector<std::uint32_t> ends;  // of indices, by material; empty: the mesh has no appearance, or these are edges
};

struct StoredMaterial {
  std::shared_ptr<const Texture> texture;
  std::array<float, 3> rgb{1, 1, 1};
};

class StoredMesh {
 public:
  StoredMesh(const GlApi& gl, std::shared_ptr<const geometry::TriangleMesh> mesh,
             std::shared_ptr<const MeshAppearance> look = nullptr);
  ~StoredMesh();
  StoredMesh(const StoredMesh&) = delete;
  StoredMesh& operator=(const StoredMesh&) = delete;

  [[nodiscard]] const Buffers& smooth() const { return smooth_; }
  // Created on first use.
  const Buffers& flat();
  const Buffers& wires();
  // Those of the triangles (or, of wires, of the edges) that face `eye`, a point in the mesh's frame, or, for w = 0,
  // the direction to it. Valid until the next call.
  const Buffers& facing(DrawMode mode, const Eigen::Vector4d& eye);

  [[nodiscard]] bool has_look() const { return dressed_; }
  // Of its appearance; uploads the textures on first use.
  const std::vector<StoredMaterial>& materials(TextureStore& textures);

  [[nodiscard]] const BoundingSphere& bounds() const { return bounds_; }
  // The mesh has no other owner; or the appearance, if the mesh is stored with several.
  [[nodiscard]] bool unshared() const { return mesh_.use_count() == 1 || look_.use_count() == 1; }
  std::uint64_t last_used = 0;  // number of the frame

 private:
  void upload(Surface& surface, Buffers& buffers);
  void append(DrawMode mode, std::uint32_t triangle);
  void select_facing(DrawMode mode, const Eigen::Vector4d& eye);

  const GlApi& gl_;
  std::shared_ptr<const geometry::TriangleMesh> mesh_;
  std::shared_ptr<const MeshAppearance> look_;  // may be null
  bool dressed_ = false;                        // has a valid appearance
  MaterialOrder order_;
  std::vector<StoredMaterial> materials_;
  BoundingSphere bounds_;
  Buffers smooth_;
  Buffers flat_;
  Buffers wires_;
  Buffers facing_;
  std::vector<Corner> smooth_corners_;  // kept for facing()
  std::vector<Eigen::Vector3f> normals_;
  std::vector<FeatureEdge> edges_;
  std::vector<bool> faces_;
  std::vector<Corner> selected_;
};

// A body's mesh and how it is scaled. Null: the body cannot be drawn.
struct ShapeUse {
  StoredMesh* mesh = nullptr;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

enum class Solid : std::uint8_t { box, cylinder, sphere, cone, funnel };

class MeshStore {
 public:
  explicit MeshStore(const GlApi& gl) : gl_(gl), textures_(gl) {}

  [[nodiscard]] ShapeUse shape_of(const SceneBody& body);
  [[nodiscard]] StoredMesh& solid(Solid solid);

  void begin_frame() { ++frame_; }
  // Drops meshes without other owners, and those not shown for a while.
  void end_frame();
  [[nodiscard]] std::size_t size() const { return meshes_.size() + capsules_.size(); }
  [[nodiscard]] std::uint64_t uploads() const { return uploads_; }
  [[nodiscard]] TextureStore& textures() { return textures_; }

 private:
  using Capsule = std::array<double, 2>;
  using Key = std::pair<const geometry::TriangleMesh*, const MeshAppearance*>;

  [[nodiscard]] StoredMesh* stored(const std::shared_ptr<const geometry::TriangleMesh>& mesh,
                                   const std::shared_ptr<const MeshAppearance>& look);

  const GlApi& gl_;
  TextureStore textures_;
  std::map<Key, std::unique_ptr<StoredMesh>> meshes_;
  std::map<Capsule, std::unique_ptr<StoredMesh>> capsules_;
  std::array<std::unique_ptr<StoredMesh>, 5> solids_;
  std::uint64_t frame_ = 0;
  std::uint64_t uploads_ = 0;
};

}  // namespace cellmirror::display
