#include "drivers/display/internal/view_transform.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace cellmirror::display {

namespace {

constexpr double kNearest = 1e-4;  // m
constexpr double kFarthest = 1e6;
constexpr double kNarrowest = 1e-3;  // rad
constexpr double kWidest = std::numbers::pi - 0.05;

double within(double value, double low, double high, double otherwise) {
  return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

Eigen::Matrix4d projection(const Eye& eye, double half_height, double aspect) {
  const double near_distance = within(eye.near_distance, kNearest, kFarthest / 2, 0.05);
  const double far_distance = std::max(within(eye.far_distance, 0, kFarthest, 100), near_distance * 1.01);
  const double depth = far_distance - near_distance;
  Eigen::Matrix4d clip_from_eye = Eigen::Matrix4d::Zero();
  clip_from_eye(0, 0) = 1 / (half_height * aspect);
  clip_from_eye(1, 1) = -1 / half_height;
  if (eye.height_m > 0) {
    clip_from_eye(2, 2) = -2 / depth;
    clip_from_eye(2, 3) = -(far_distance + near_distance) / depth;
    clip_from_eye(3, 3) = 1;
  } else {
    clip_from_eye(2, 2) = -(far_distance + near_distance) / depth;
    clip_from_eye(2, 3) = -2 * far_distance * near_distance / depth;
    clip_from_eye(3, 2) = -1;
  }
  return clip_from_eye;
}

}  // namespace

std::optional<PixelRect> pixels_of(const Pane& pane, int width, int height) {
  const auto at = [](double part, int size) {
    return static_cast<int>(std::lround(within(part, 0, 1, 0) * static_cast<double>(size)));
  };
  PixelRect rect{at(pane.left, width), at(pane.top, height), 0, 0};
  rect.width = at(pane.left + pane.width, width) - rect.x;
  rect.height = at(pane.top + pane.height, height) - rect.y;
  if (rect.width < 1 || rect.height < 1) return std::nullopt;
  return rect;
}

std::optional<ViewTransform> ViewTransform::of(const Pane& pane, int width, int height) {
  const std::optional<PixelRect> pixels = pixels_of(pane, width, height);
  const Eigen::Matrix4d& matrix = pane.eye.X_WE.matrix();
  if (!pixels || !matrix.allFinite() || matrix.cwiseAbs().maxCoeff() > kFarthest) return std::nullopt;
  ViewTransform view;
  view.pixels_ = *pixels;
  view.X_WE_ = pane.eye.X_WE;
  view.parallel_ = pane.eye.height_m > 0;
  view.half_height_ = view.parallel_ ? within(pane.eye.height_m, 1e-3, kFarthest, 1) / 2
                                     : std::tan(within(pane.eye.opening_angle, kNarrowest, kWidest, 0.7) / 2);
  const double aspect = static_cast<double>(pixels->width) / pixels->height;
  view.clip_from_world_ = projection(pane.eye, view.half_height_, aspect) * pane.eye.X_WE.inverse().matrix();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::Vector4d w = view.clip_from_world_.row(3);
    const Eigen::Vector4d along = view.clip_from_world_.row(static_cast<Eigen::Index>(axis));
    view.planes_[2 * axis] = w + along;
    view.planes_[2 * axis + 1] = w - along;
  }
  for (Eigen::Vector4d& plane : view.planes_) plane /= std::max(plane.head<3>().norm(), 1e-12);
  return view;
}

Eigen::Vector2d ViewTransform::pixel(const Eigen::Vector4d& clip) const {
  return {pixels_.x + (clip.x() / clip.w() + 1) / 2 * pixels_.width,
          pixels_.y + (clip.y() / clip.w() + 1) / 2 * pixels_.height};
}

Eigen::Vector4d ViewTransform::eye() const {
  if (parallel_) return (Eigen::Vector4d() << X_WE_.linear().col(2), 0).finished();
  return X_WE_.translation().homogeneous();
}

double ViewTransform::distance(const Eigen::Vector3d& p_W) const {
  return X_WE_.linear().col(2).dot(X_WE_.translation() - p_W);
}

double ViewTransform::metres_per_pixel(double distance) const {
  return 2 * half_height_ * (parallel_ ? 1 : std::max(distance, kNearest)) / pixels_.height;
}

bool ViewTransform::sees(const Eigen::Vector3d& centre_W, double radius) const {
  return std::all_of(planes_.begin(), planes_.end(),
                     [&](const Eigen::Vector4d& plane) { return plane.dot(centre_W.homogeneous()) > -radius; });
}

bool ViewTransform::before_eye(const Eigen::Vector3d& centre_W, double radius) const {
  constexpr std::size_t kNearPlane = 4;
  return planes_[kNearPlane].dot(centre_W.homogeneous()) > radius;
}

}  // namespace cellmirror::display
