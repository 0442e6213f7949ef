// Draws the bodies of a scene. Private to this folder.
#pragma once

#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/mesh_store.hpp"
#include "drivers/display/internal/shader_program.hpp"

namespace cellmirror::display {

// A body, or a part of an arrow or of axes, as it is drawn.
struct DrawnBody {
  StoredMesh* mesh = nullptr;
  Eigen::Matrix4d X_WM;   // with the scale of the mesh
  Colour rgba{};          // sRGB, with its mark
  bool textured = false;  // with the pictures of its mesh
  Colour own{};           // sRGB, without its mark; visible through transparent textures
  Colour over{};          // its mark's colour and, as alpha, the share that it has in any other
  DrawMode mode = DrawMode::gouraud;
  Mark mark = Mark::none;
  std::uint32_t object = 0;
  bool casts_shadow = false;
  double distance = 0;        // of its centre from the eye, m
  bool visible = true;        // by the visibility test
  BoundingSphere bounds_W{};  // of the whole
  [[nodiscard]] bool see_through() const {
    constexpr float kOpaque = 0.996F;
    return rgba[3] < kOpaque;
  }
};

// What can be drawn of the scene's bodies: finite, of sensible size, with triangles.
[[nodiscard]] std::vector<DrawnBody> drawn_bodies(const Scene& scene, MeshStore& meshes);
// The same of others; `pictures`: with their textures.
void add_drawn(std::span<const SceneBody> bodies, bool pictures, MeshStore& meshes, std::vector<DrawnBody>& all);

struct BodyCounts {
  std::uint64_t drawn = 0;
  std::uint64_t left_out = 0;
};

class BodyPass {
 public:
  BodyPass(const GlApi& gl, TextureStore& textures);
  Result<void> build();

  // Sets distance and visible of each body for this pane; counts.
  static BodyCounts examine(const Frame& frame, std::vector<DrawnBody>& bodies);
  // First solid bodies and wireframes, then, after all opaque objects, transparent ones.
  void draw_opaque(const Frame& frame, std::vector<DrawnBody>& bodies);
  void draw_see_through(const Frame& frame, std::vector<DrawnBody>& bodies);
  // The number of each body's object.
  void draw_objects(const Frame& frame, std::vector<DrawnBody>& bodies);
  // Bodies that are no geometry of the cell: never culled, lit from both sides where see-through.
  void draw_extra(const Frame& frame, const std::vector<DrawnBody>& bodies);

 private:
  struct Uniforms {
    GLint clip_from_mesh = -1;
    GLint world_from_normal = -1;
    GLint rgb = -1;
    GLint alpha = -1;
    GLint to_eye = -1;
    GLint object = -1;
    GLint picture = -1;
    GLint material = -1;
    GLint own = -1;
    GLint over = -1;
  };
  struct Shading {
    explicit Shading(const GlApi& gl) : program(gl) {}
    ShaderProgram program;
    Uniforms uniforms;
    // With pictures; built when first needed, and null where the driver refuses it.
    std::unique_ptr<Shading> textured;
    bool tried = false;
  };

  void use(const Frame& frame, Shading& shading);
  static Result<void> build(Shading& shading, std::string_view fragment,
                            std::initializer_list<std::string_view> defines);
  // The same with pictures, or the plain one.
  Shading& with_pictures(Shading& shading);
  void put(const Frame& frame, const DrawnBody& body);
  void draw_parts(const DrawnBody& body, const Buffers& buffers);
  void draw(const Frame& frame, const DrawnBody& body);
  [[nodiscard]] Shading& shading_of(const Frame& frame, const DrawnBody& body);
  void draw_ghosts(const Frame& frame, std::span<const DrawnBody* const> ghosts);

  const GlApi& gl_;
  TextureStore& textures_;
  Shading one_sided_;
  Shading two_sided_;
  Shading striped_;
  Shading plain_;
  Shading objects_;
  Shading* used_ = nullptr;
};

}  // namespace cellmirror::display
