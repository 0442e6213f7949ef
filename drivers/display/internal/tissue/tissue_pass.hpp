// Draws the deforming surfaces of a scene. Private to this folder.
#pragma once

#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/shader_program.hpp"
#include "drivers/display/internal/shadow_map.hpp"
#include "drivers/display/internal/tissue/tissue_mesh.hpp"

namespace cellmirror::display {

class TissuePass {
 public:
  TissuePass(const GlApi& gl, TextureStore& textures);
  Result<void> build();

  // Uploads what has changed since the last call. The scene's view is kept until the next one.
  void prepare(const Scene& scene);
  // Those that throw shadows, as of the last prepare().
  [[nodiscard]] std::span<const CastingSurface> casting() const { return casting_; }
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }  // W; may be empty
  // Opaque ones and wireframes; then, after all that is opaque, transparent ones.
  void draw_opaque(const Frame& frame);
  void draw_see_through(const Frame& frame);
  [[nodiscard]] std::uint64_t topology_uploads() const { return topology_uploads_; }

 private:
  struct Shading {
    explicit Shading(const GlApi& gl) : program(gl) {}
    ShaderProgram program;
    GLint clip_from_world = -1;
    GLint eye = -1;
    GLint to_eye = -1;
    GLint wet = -1;
    GLint raw = -1;
    GLint alpha = -1;
    GLint picture = -1;
    GLint material = -1;
  };
  struct Drawn {
    std::unique_ptr<TissueMesh> mesh;
    bool usable = false;  // as of the last view
    bool wet = false;
    DrawMode mode = DrawMode::gouraud;
  };

  Result<void> build(Shading& shading, std::initializer_list<std::string_view> defines);
  void upload(const TissueView& view);
  [[nodiscard]] Shading& shading_of(DrawMode mode, bool textured);
  void use(const Frame& frame, const Shading& shading, const Drawn& surface);
  void draw(const Frame& frame, Drawn& surface);
  void draw_those(const Frame& frame, bool see_through);
  [[nodiscard]] static bool back_faces_wanted(const Frame& frame, const Drawn& surface);

  const GlApi& gl_;
  TextureStore& textures_;
  Shading smooth_;
  Shading smooth_textured_;
  Shading flat_;
  Shading flat_textured_;
  Shading plain_;
  std::shared_ptr<const TissueView> view_;
  std::vector<Drawn> surfaces_;  // as those of the view
  std::vector<CastingSurface> casting_;
  Eigen::AlignedBox3d bounds_;
  std::uint64_t version_ = 0;  // of what was uploaded
  std::uint64_t topology_uploads_ = 0;
};

}  // namespace cellmirror::display
