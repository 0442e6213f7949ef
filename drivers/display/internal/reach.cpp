#include "drivers/display/internal/reach.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/display/internal/volume/volume_casting.hpp"

namespace cellmirror::display {

namespace {

constexpr double kFarthestDrawn = 1e5;       // m
constexpr double kNearestPart = 1.0 / 5000;  // of the far distance
constexpr double kNearestMost = 0.01;        // m
constexpr double kBeyond = 1.01;             // of the reach: nothing is in the far plane itself

void include(Box& reach, const Eigen::Vector3d& centre, double radius = 0) {
  if (!centre.allFinite() || !(radius >= 0) || radius > kFarthestDrawn) return;
  if (centre.cwiseAbs().maxCoeff() > kFarthestDrawn) return;
  reach.extend(centre - Eigen::Vector3d::Constant(radius));
  reach.extend(centre + Eigen::Vector3d::Constant(radius));
}

}  // namespace

Box reach_of(const Scene& scene, std::span<const DrawnBody> bodies) {
  Box reach;
  for (const DrawnBody& body : bodies) include(reach, body.bounds_W.centre, body.bounds_W.radius);
  for (const SceneVolume& shown : scene.volumes) {
    if (shown.grid == nullptr) continue;
    for (const Eigen::Vector3d& corner : corners_of(shown)) include(reach, corner);
  }
  for (const SceneAxes& axes : scene.axes) include(reach, axes.X_WF.translation(), axes.length_m);
  for (const SceneLine& line : scene.lines) {
    include(reach, line.from);
    include(reach, line.to);
  }
  for (const SceneTrace& trace : scene.traces) {
    for (const Eigen::Vector3f& point : trace.points) include(reach, point.cast<double>());
  }
  for (const SceneCone& cone : scene.cones) include(reach, cone.X_WS.translation(), cone.length_m);
  for (const SceneArrow& arrow : scene.arrows) include(reach, arrow.from, 1.1 * arrow.along.norm());
  for (const SceneSpark& spark : scene.sparks) include(reach, spark.at, 0.1);
  for (const SceneLabel& label : scene.labels) include(reach, label.at);
  return reach;
}

Eye bounded_by(const Box& reach, Eye eye) {
  double farthest = 0;
  for (int corner = 0; corner < 8 && !reach.isEmpty(); ++corner) {
    const Eigen::Vector3d p_W = reach.corner(static_cast<Box::CornerType>(corner));
    farthest = std::max(farthest, eye.X_WE.linear().col(2).dot(eye.X_WE.translation() - p_W));
  }
  if (!(eye.far_distance < kBeyond * farthest)) eye.far_distance = kBeyond * farthest;
  if (!(eye.height_m > 0))
    eye.near_distance = std::max(eye.near_distance, std::min(kNearestPart * eye.far_distance, kNearestMost));
  return eye;
}

}  // namespace cellmirror::display
