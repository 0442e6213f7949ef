#include "rt_core/cell/view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace cellmirror {

namespace {

constexpr double kFarthest = 10'000.0;  // m

// Radius of a sphere about the shape's own frame. Of a mesh only the place is known here.
double radius_of(const Geometry& geometry) {
  switch (geometry.shape) {
    case Shape::box:
      return 0.5 * geometry.size.norm();
    case Shape::cylinder:
      return std::hypot(geometry.size.x(), 0.5 * geometry.size.y());
    case Shape::sphere:
      return geometry.size.x();
    case Shape::capsule:
      return geometry.size.x() + 0.5 * geometry.size.y();
    case Shape::mesh:
      return 0.0;
  }
  return 0.0;
}

View whole(const Extent& extent, const Eigen::Vector3d& towards_viewer, bool orthogonal) {
  constexpr double kOpeningAngle = 40.0 * std::numbers::pi / 180.0;
  const double radius = std::max(0.5 * (extent.high - extent.low).norm(), 0.1);
  const double distance = radius / std::sin(0.5 * kOpeningAngle);
  View view;
  view.lookpoint = 0.5 * (extent.low + extent.high);
  view.viewpoint = view.lookpoint + distance * towards_viewer.normalized();
  view.opening_angle = kOpeningAngle;
  view.near_distance = 0.01 * distance;
  view.far_distance = distance + 4.0 * radius;
  view.orthogonal = orthogonal;
  return view;
}

}  // namespace

Eigen::Matrix3d screen_axes(const View& view) {
  constexpr double kVertical = 1e-6;
  const Eigen::Vector3d z = (view.viewpoint - view.lookpoint).normalized();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  if (up.cross(z).norm() < kVertical) up = Eigen::Vector3d::UnitY();
  Eigen::Matrix3d R_WS;
  R_WS.col(0) = up.cross(z).normalized();
  R_WS.col(1) = z.cross(R_WS.col(0));
  R_WS.col(2) = z;
  return R_WS * Eigen::AngleAxisd(view.twist, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

Extent extent_of(const CompiledCell& cell, std::span<const JointValues> q) {
  if (cell.geometry.empty()) return {};
  CellPoses poses;
  compute_poses(cell, q, poses);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent extent{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
  for (const CompiledGeometry& part : cell.geometry) {
    const Pose X_WG = poses.X_WN[static_cast<std::size_t>(part.node)] * part.geometry->X_NG;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_of(*part.geometry));
    extent.low = extent.low.cwiseMin(X_WG.translation() - reach);
    extent.high = extent.high.cwiseMax(X_WG.translation() + reach);
  }
  return extent;
}

Views::Views(const Extent& extent) {
  const Eigen::Vector3d above = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d side = -Eigen::Vector3d::UnitY();
  views_ = {whole(extent, {-0.5, -0.7, 0.4}, false),
            whole(extent, above, true),
            whole(extent, side, true),
            whole(extent, above, true),
            whole(extent, side, true),
            whole(extent, side, false),
            whole(extent, {-0.3, -0.4, 0.85}, false)};
}

Result<void> Views::set(int id, const View& view) {
  if (id < 0 || id >= kViews) return fail(fmt::format("there is no view {}", id), "views are 0 to 6");
  const auto near_enough = [](const Eigen::Vector3d& p) {
    return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest;
  };
  if (!near_enough(view.viewpoint) || !near_enough(view.lookpoint))
    return fail(fmt::format("the viewpoint or lookpoint of view {} lies beyond {:g} m", id, kFarthest));
  if ((view.viewpoint - view.lookpoint).norm() < 1e-6)
    return fail(fmt::format("the viewpoint of view {} is its lookpoint", id), "give VP and LP apart from each other");
  if (!std::isfinite(view.twist)) return fail(fmt::format("the twist angle of view {} is no number", id));
  if (!(view.opening_angle > 0.0 && view.opening_angle < std::numbers::pi))
    return fail(fmt::format("the viewing angle of view {} is not between 0 and 180 degrees", id));
  if (!(view.near_distance >= 0.0 && view.far_distance > view.near_distance && std::isfinite(view.far_distance))) {
    return fail(fmt::format("the clipping planes of view {} leave nothing between them: front {:.6g} m, back {:.6g} m",
                            id, view.near_distance, view.far_distance),
                "the front plane (FCP) is nearer than the back plane (BCP)");
  }
  views_[static_cast<std::size_t>(id)] = view;
  return {};
}

Result<void> Views::change(int id, const ViewChange& change) {
  if (id < 0 || id >= kViews) return fail(fmt::format("there is no view {}", id), "views are 0 to 6");
  View changed = view(id);
  changed.viewpoint = change.viewpoint.value_or(changed.viewpoint);
  changed.lookpoint = change.lookpoint.value_or(changed.lookpoint);
  changed.twist = change.twist.value_or(changed.twist);
  changed.opening_angle = change.opening_angle.value_or(changed.opening_angle);
  changed.near_distance = change.near_distance.value_or(changed.near_distance);
  changed.far_distance = change.far_distance.value_or(changed.far_distance);
  return set(id, changed);
}

Result<void> Views::set_display(int display, bool full_screen) {
  if (display < 1 || display > kDisplays)
    return fail(fmt::format("there is no display {}", display), "STDP takes 1 to 6");
  display_ = display;
  full_screen_ = full_screen;
  return {};
}

// Manual 1.2.3, COVW: the views of each display.
int Views::current_id() const {
  constexpr std::array<int, kDisplays> kFirstView = {0, 1, 3, 4, 5, 6};
  return kFirstView[static_cast<std::size_t>(display_ - 1)];
}

}  // namespace cellmirror
