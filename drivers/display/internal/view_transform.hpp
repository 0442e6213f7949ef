// From the world to the pixels of a pane. Private to this folder; no OpenGL.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "drivers/display/internal/surface.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

struct PixelRect {
  int x = 0;  // from the upper left corner
  int y = 0;
  int width = 0;
  int height = 0;
};

// Clip space as OpenGL's, but with y downwards: row 0 of a RenderTarget is the picture's upper one.
class ViewTransform {
 public:
  // None where the eye is not finite or the pane has no pixels.
  [[nodiscard]] static std::optional<ViewTransform> of(const Pane& pane, int width, int height);

  [[nodiscard]] const Eigen::Matrix4d& clip_from_world() const { return clip_from_world_; }
  [[nodiscard]] Eigen::Vector4d clip(const Eigen::Vector3d& p_W) const { return clip_from_world_ * p_W.homogeneous(); }
  // Where a point of clip space with w > 0 is drawn, pixels of the picture.
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector4d& clip) const;
  [[nodiscard]] const Pose& X_WE() const { return X_WE_; }
  // Homogeneous: a point (w = 1), or the direction to it of a parallel projection (w = 0).
  [[nodiscard]] Eigen::Vector4d eye() const;
  [[nodiscard]] double distance(const Eigen::Vector3d& p_W) const;  // along the eye's axis, m
  // How much of the world a pixel covers at such a distance, m.
  [[nodiscard]] double metres_per_pixel(double distance) const;
  [[nodiscard]] bool sees(const Eigen::Vector3d& centre_W, double radius) const;
  // All of it is beyond the near plane.
  [[nodiscard]] bool before_eye(const Eigen::Vector3d& centre_W, double radius) const;
  [[nodiscard]] const PixelRect& pixels() const { return pixels_; }

 private:
  ViewTransform() = default;

  Eigen::Matrix4d clip_from_world_ = Eigen::Matrix4d::Identity();
  std::array<Eigen::Vector4d, 6> planes_;  // inside: positive; normals of unit length
  Pose X_WE_ = Pose::Identity();
  bool parallel_ = false;
  double half_height_ = 1;  // visible extent: at a distance of 1 m, or, of a parallel projection, anywhere
  PixelRect pixels_;
};

[[nodiscard]] std::optional<PixelRect> pixels_of(const Pane& pane, int width, int height);

}  // namespace cellmirror::display
