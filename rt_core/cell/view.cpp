#include "rt_core/cell/view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "rt_core/base/units.hpp"

namespace cellmirror {

namespace {

// How far a shape reaches from the origin of its frame G along the axes of the world, m.
Eigen::Vector3d reach_of(const Geometry& geometry, const Eigen::Matrix3d& R_WG) {
  const Eigen::Vector3d z = R_WG.col(2).cwiseAbs();
  const double radius = geometry.size.x();
  switch (geometry.shape) {
    case Shape::box:
      return R_WG.cwiseAbs() * (0.5 * geometry.size);
    case Shape::cylinder:
      return radius * (1.0 - z.array().square()).max(0.0).sqrt().matrix() + 0.5 * geometry.size.y() * z;
    case Shape::sphere:
      return Eigen::Vector3d::Constant(radius);
    case Shape::capsule:
      return Eigen::Vector3d::Constant(radius) + 0.5 * geometry.size.y() * z;
    case Shape::mesh:
      return Eigen::Vector3d::Zero();
  }
  return Eigen::Vector3d::Zero();
}

void include(const Eigen::Vector3d& p_W, Extent& extent) {
  extent.low = extent.low.cwiseMin(p_W);
  extent.high = extent.high.cwiseMax(p_W);
}

constexpr double kAspect = 4.0 / 3.0;  // of a picture, width to height

// Of the narrowest pane that shows the view; never wider than the picture.
double aspect_of(const DisplayLayout& layout, std::size_t view) {
  double aspect = kAspect;
  for (const LayoutDisplay& display : layout.displays) {
    for (const LayoutPane& pane : display.panes) {
      if (pane.view == static_cast<int>(view)) aspect = std::min(aspect, kAspect * pane.width / pane.height);
    }
  }
  return aspect;
}

// So far away that all corners are in the picture, with some room beside them.
View whole(const Extent& extent, const Eigen::Vector3d& towards_viewer, bool orthogonal, double aspect) {
  constexpr double kOpeningAngle = 40.0 * std::numbers::pi / 180.0;
  constexpr double kRoom = 1.08;
  const Eigen::Vector3d half_size = 0.5 * (extent.high - extent.low);
  const double radius = std::max(half_size.norm(), 0.1);
  View view;
  view.lookpoint = 0.5 * (extent.low + extent.high);
  view.viewpoint = view.lookpoint + towards_viewer.normalized();
  const Eigen::Matrix3d R_WS = screen_axes(view);
  double distance = radius;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    const Eigen::Vector3d p_S = R_WS.transpose() * side.cwiseProduct(half_size);
    const double aside = std::max(std::abs(p_S.y()), std::abs(p_S.x()) / aspect) / std::tan(0.5 * kOpeningAngle);
    distance = std::max(distance, orthogonal ? aside : p_S.z() + aside);
  }
  distance *= kRoom;
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
  if (cell.geometry.empty() && cell.volumes.empty()) return {};
  CellPoses poses;
  compute_poses(cell, q, poses);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent extent{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
  for (const CompiledGeometry& part : cell.geometry) {
    const Geometry& geometry = *part.geometry;
    if (!geometry.drawn) continue;
    const Pose X_WG = poses.X_WN[static_cast<std::size_t>(part.node)] * geometry.X_NG;
    const Eigen::Vector3d reach = reach_of(geometry, X_WG.linear());
    include(X_WG.translation() - reach, extent);
    include(X_WG.translation() + reach, extent);
    if (geometry.shape != Shape::mesh || geometry.mesh == nullptr) continue;
    for (const Eigen::Vector3d& vertex : geometry.mesh->vertices) include(X_WG * vertex, extent);
  }
  for (const CompiledVolume& part : cell.volumes) {
    if (cell.visible[static_cast<std::size_t>(part.node)] == 0) continue;
    const Pose X_WV = poses.X_WN[static_cast<std::size_t>(part.node)] * part.volume->X_CV;
    const Eigen::Vector3d reach = X_WV.linear().cwiseAbs() * part.volume->grid->half_extent_m();
    include(X_WV.translation() - reach, extent);
    include(X_WV.translation() + reach, extent);
  }
  return extent.low.allFinite() ? extent : Extent{};
}

std::array<View, kViews> views_of_extent(const Extent& extent, const DisplayLayout& layout) {
  std::array<View, kViews> views;
  for (std::size_t id = 0; id < kViews; ++id) {
    const LayoutView& view = layout.views[id];
    views[id] = whole(extent, view.towards_viewer, view.orthogonal, aspect_of(layout, id));
  }
  return views;
}

Result<void> check_view_id(int id) {
  if (id < 0 || id >= static_cast<int>(kViews)) return fail(fmt::format("there is no view {}", id), "views are 0 to 6");
  return {};
}

Result<void> check_view(int id, const View& view) {
  if (auto known = check_view_id(id); !known) return known;
  const auto near_enough = [](const Eigen::Vector3d& p) {
    return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthestView;
  };
  if (!near_enough(view.viewpoint) || !near_enough(view.lookpoint))
    return fail(fmt::format("the viewpoint or lookpoint of view {} is beyond {:.10g} m ({:.10g} mm)", id, kFarthestView,
                            mm_from_m(kFarthestView)));
  if ((view.viewpoint - view.lookpoint).norm() < kNearestLookpoint)
    return fail(fmt::format("the viewpoint of view {} is its lookpoint", id), "give different points for VP and LP");
  if (!std::isfinite(view.twist)) return fail(fmt::format("the twist angle of view {} is not a number", id));
  if (!(view.opening_angle > 0.0 && view.opening_angle < std::numbers::pi))
    return fail(fmt::format("the viewing angle of view {} is not between 0 and 180 degrees", id));
  if (!(view.near_distance >= 0.0 && view.far_distance > view.near_distance && std::isfinite(view.far_distance))) {
    return fail(
        fmt::format(
            "the front clipping plane of view {} is not in front of the back one: front {:.6g} m, back {:.6g} m", id,
            view.near_distance, view.far_distance),
        "the front plane (FCP) must be nearer than the back plane (BCP)");
  }
  return {};
}

View changed_by(View view, const ViewChange& change) {
  view.viewpoint = change.viewpoint.value_or(view.viewpoint);
  view.lookpoint = change.lookpoint.value_or(view.lookpoint);
  view.twist = change.twist.value_or(view.twist);
  view.opening_angle = change.opening_angle.value_or(view.opening_angle);
  view.near_distance = change.near_distance.value_or(view.near_distance);
  view.far_distance = change.far_distance.value_or(view.far_distance);
  return view;
}

}  // namespace cellmirror
