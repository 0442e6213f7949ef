// The soft shadow of bodies on the floor: their outlines along the light, drawn from below and blurred; what is near
// the floor less than what is high above it. Private to this folder.
#pragma once

#include <span>
#include <vector>

#include "drivers/display/internal/body_pass.hpp"
#include "drivers/display/internal/render_target.hpp"

namespace cellmirror::display {

// A byte a place, 255: dark.
struct ShadowPicture {
  static constexpr int kEdge = 384;
  std::vector<std::uint8_t> bytes;
};

// Blurs `plane` (edge * edge) by a box of 2 * radius + 1, twice in each direction, which is nearly a Gaussian curve.
void blur(std::vector<std::uint8_t>& plane, int edge, int radius);

// A surface that is not of a stored mesh: attribute 0 of its vertex array is the position, W.
struct CastingSurface {
  GLuint array = 0;
  GLsizei corners = 0;
  BoundingSphere bounds_W;
  std::uint64_t version = 0;  // another one: it may have moved
};

class ShadowMap {
 public:
  explicit ShadowMap(const GlApi& gl) : gl_(gl), program_(gl), target_(gl) {}
  ~ShadowMap() {
    if (texture_ != 0) gl_.DeleteTextures(1, &texture_);
  }
  ShadowMap(const ShadowMap&) = delete;
  ShadowMap& operator=(const ShadowMap&) = delete;

  Result<void> build();
  // Of what is above the level `z_m` (W); `extent_m`, the size of the cell, says how soft. Binds its own target.
  // Nothing is drawn where nothing has moved since the last call.
  Result<void> update(double z_m, double extent_m, std::span<const DrawnBody> bodies,
                      std::span<const CastingSurface> surfaces = {});
  [[nodiscard]] GLuint texture() const { return texture_; }
  // x, y of the lower corner, W, m; and 1 / its edges: as the shadow falls on a level at `z_m`.
  [[nodiscard]] Eigen::Vector4f part_at(double z_m) const;

 private:
  void draw(std::span<const DrawnBody* const> casting, std::span<const CastingSurface> surfaces);
  void draw_casting(std::span<const DrawnBody* const> casting, std::span<const CastingSurface> surfaces,
                    const Eigen::Matrix4d& projection, const Eigen::Matrix4d& clip_from_shadow);
  void soften_and_upload();

  const GlApi& gl_;
  ShaderProgram program_;
  RenderTarget target_;
  GLuint texture_ = 0;
  Eigen::Vector4f part_ = Eigen::Vector4f::Zero();
  double level_ = 0;   // m, W
  double extent_ = 1;  // m
  double edge_m_ = 1;
  std::vector<double> shown_;  // what the texture was made from
  std::vector<std::uint8_t> covered_;
};

}  // namespace cellmirror::display
