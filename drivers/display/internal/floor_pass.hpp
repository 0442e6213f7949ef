// The floor: a disc that fades into the background, a grid of metres, the shadow, and tiles where textures are on.
// Private to this folder.
#pragma once

#include <Eigen/Geometry>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/ribbon_pass.hpp"
#include "drivers/display/internal/shadow_map.hpp"

namespace cellmirror::display {

class FloorPass {
 public:
  explicit FloorPass(const GlApi& gl)
      : gl_(gl), shadow_map_(gl), plain_(gl), shadow_(gl), tiles_(gl), tiles_and_shadow_(gl), shadow_alone_(gl) {}
  ~FloorPass();
  FloorPass(const FloorPass&) = delete;
  FloorPass& operator=(const FloorPass&) = delete;

  Result<void> build();
  // Once a picture, before its target is bound: shadows are the same from everywhere.
  Result<void> prepare(const Scene& scene, std::span<const DrawnBody> bodies,
                       std::span<const CastingSurface> surfaces = {});
  // As prepared, at the height of the floor.
  [[nodiscard]] Eigen::AlignedBox3d reach(const Scene& scene) const;
  // After what is opaque. From below, the floor is not drawn, so that the cell is visible.
  void draw(const Frame& frame, RibbonPass& ribbon_pass);

 private:
  void make_disc(const Scene& scene);
  void upload(const std::vector<float>& vertices, const std::vector<std::uint32_t>& indices);
  void put(const Frame& frame, const ShaderProgram& program, double z_m);
  // The shadow alone, on the cell's base slab.
  void draw_catchers(const Frame& frame);
  void make_tiles();
  void gather_grid(const Frame& frame);
  [[nodiscard]] ShaderProgram& program_of(const Scene& scene);

  const GlApi& gl_;
  ShadowMap shadow_map_;
  ShaderProgram plain_;
  ShaderProgram shadow_;
  ShaderProgram tiles_;
  ShaderProgram tiles_and_shadow_;
  ShaderProgram shadow_alone_;
  GLuint array_ = 0;
  GLuint vertices_ = 0;
  GLuint indices_ = 0;
  GLsizei count_ = 0;
  GLuint tiles_texture_ = 0;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  double shadow_level_ = 0;  // m, W
  double inner_ = 1;         // m: radius up to which the floor is opaque
  double outer_ = 2;         // m: where it has faded out
  Ribbons grid_;
};

}  // namespace cellmirror::display
