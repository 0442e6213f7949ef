// Views where they are now, and the eye of a view.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "rt_core/cell/view.hpp"
#include "rt_core/scene/cameras.hpp"
#include "rt_core/scene/panes.hpp"

namespace cellmirror::scene {

namespace {

constexpr double kOnTheSpot = 1e-9;      // m
constexpr double kCameraNearest = 0.05;  // m: what is in front of a camera is not cut away by a view made for the cell

constexpr double kBeforeHousing = 1.02;

double part_of(const ViewSequence& sequence, Timestamp now, std::uint64_t updates) {
  if (sequence.duration.count() > 0) return seconds(now - sequence.begin) / seconds(sequence.duration);
  if (sequence.steps == 0) return 1.0;
  const std::uint64_t done = updates > sequence.first_step ? updates - sequence.first_step : 0;
  return static_cast<double>(done) / static_cast<double>(sequence.steps);
}

}  // namespace

bool ended(const ViewSequence& sequence, Timestamp now, std::uint64_t updates) {
  return part_of(sequence, now, updates) >= 1.0;
}

View between(const View& from, const View& to, double part) {
  const double t = std::clamp(part, 0.0, 1.0);
  const auto mix = [t](const auto& a, const auto& b) { return ((1.0 - t) * a + t * b); };
  View view = to;
  view.viewpoint = mix(from.viewpoint, to.viewpoint);
  view.lookpoint = mix(from.lookpoint, to.lookpoint);
  view.twist = mix(from.twist, to.twist);
  view.opening_angle = mix(from.opening_angle, to.opening_angle);
  view.near_distance = mix(from.near_distance, to.near_distance);
  view.far_distance = mix(from.far_distance, to.far_distance);
  return view;
}

View view_of_camera(const CameraNow& camera, const View& clipped_as) {
  View view = clipped_as;
  view.orthogonal = false;
  view.twist = 0.0;
  view.viewpoint = camera.X_WC.translation();
  const double distance = std::max(camera.focal_distance_m, 1e-3);
  view.lookpoint = view.viewpoint + distance * camera.X_WC.linear().col(2);
  view.opening_angle = camera.fovy_rad;
  // The camera's x is the picture's: twist is the rotation of the screen to that x.
  const Eigen::Matrix3d R_WS = screen_axes(view);
  const Eigen::Vector3d x_S = R_WS.transpose() * camera.X_WC.linear().col(0);
  view.twist = std::atan2(x_S.y(), x_S.x());
  view.near_distance = std::max(std::min(clipped_as.near_distance, kCameraNearest), kBeforeHousing * camera.housing_m);
  return view;
}

View view_now(const PaneInput& input, int id) {
  const auto index = static_cast<std::size_t>(std::clamp(id, 0, static_cast<int>(kViews) - 1));
  const DisplayView& shown = input.display.views[index];
  if (!shown.camera.empty()) {
    if (const auto camera = camera_now(input.cell, input.poses, input.display, shown.camera)) {
      View view = view_of_camera(*camera, shown.view);
      if (shown.front_plane_set) view.near_distance = std::max(view.near_distance, shown.view.near_distance);
      return view;
    }
  }
  if (!shown.sequence) return shown.view;
  return between(shown.sequence->from, shown.sequence->to, part_of(*shown.sequence, input.now, input.updates));
}

Eye eye_of(const View& view) {
  View seen = view;
  // A sequence may lead the viewpoint through the lookpoint.
  if (!((seen.viewpoint - seen.lookpoint).norm() > kOnTheSpot))
    seen.lookpoint = seen.viewpoint + Eigen::Vector3d::UnitY();
  Eye eye;
  eye.X_WE.linear() = screen_axes(seen);
  eye.X_WE.translation() = seen.viewpoint;
  eye.opening_angle = seen.opening_angle;
  if (seen.orthogonal)
    eye.height_m = 2.0 * (seen.viewpoint - seen.lookpoint).norm() * std::tan(0.5 * seen.opening_angle);
  eye.far_distance = seen.far_distance;
  eye.near_distance = seen.near_distance;
  return eye;
}

}  // namespace cellmirror::scene
