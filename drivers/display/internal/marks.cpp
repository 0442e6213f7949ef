#include "drivers/display/internal/marks.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "rt_core/ports/palette.hpp"
#include "rt_core/ports/voxel_grid.hpp"
#include "rt_core/volume/planes.hpp"

namespace cellmirror::display {

namespace {

constexpr std::size_t kMost = 5000;         // of each kind
constexpr std::size_t kMostPoints = 20000;  // of all traces together
constexpr double kFarthest = 1e5;           // m
constexpr double kHeadRadius = 0.38;        // of an arrow's head, of its length

bool sensible(const Eigen::Vector3d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest; }
bool sensible(const Pose& X) { return X.matrix().allFinite() && X.matrix().cwiseAbs().maxCoeff() < kFarthest; }

Colour faded(Colour colour, float alpha) {
  colour[3] *= alpha;
  return colour;
}

// The silhouette edges of a cone: from its tip, its base is back along `direction`.
void outline_head(const Frame& frame, const Eigen::Vector3d& tip, const Eigen::Vector3d& direction, double length,
                  const Ribbons::Style& style, Ribbons& ribbons) {
  const Eigen::Vector4d eye = frame.view.eye();
  Eigen::Vector3d side = direction.cross(eye.head<3>() - eye.w() * tip);
  if (!(side.norm() > 0)) side = frame.view.X_WE().linear().col(0);
  const Eigen::Vector3d base = tip - length * direction;
  const Eigen::Vector3d across = kHeadRadius * length * side.normalized();
  ribbons.line(frame.view, base + across, tip, style);
  ribbons.line(frame.view, base - across, tip, style);
  ribbons.line(frame.view, base - across, base + across, style);
}

// A solid of unit size with its z axis along `along`, its origin at `from`.
DrawnBody solid_along(StoredMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& along, double radius,
                      double length, const Colour& rgba) {
  DrawnBody body;
  body.mesh = &mesh;
  Pose X_WM = Pose::Identity();
  X_WM.translation() = from;
  X_WM.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along).toRotationMatrix();
  body.X_WM = X_WM.matrix() * Eigen::Vector4d(radius, radius, length, 1).asDiagonal();
  body.rgba = rgba;
  return body;
}

}  // namespace

void Marks::gather(const Frame& frame, MeshStore& meshes) {
  hidden_by_bodies.clear();
  on_top.clear();
  solids.clear();
  see_through.clear();
  const Scene& scene = frame.scene;
  const auto some = [](const auto& all) { return std::span(all).first(std::min(all.size(), kMost)); };
  for (const SceneAxes& axes : some(scene.axes)) add_axes(frame, meshes, axes);
  for (const SceneLine& line : some(scene.lines)) {
    if (frame.own(line.camera) || !sensible(line.from) || !sensible(line.to)) continue;
    (line.on_top ? on_top : hidden_by_bodies)
        .line(frame.view, line.from, line.to, {line.rgba, line.rgba, line.width_px, line.dashed});
  }
  for (const SceneTrace& trace : some(scene.traces)) add_trace(frame, trace);
  for (const SceneCone& cone : some(scene.cones)) add_cone(frame, meshes, cone);
  for (const SceneArrow& arrow : some(scene.arrows)) add_arrow(frame, meshes, arrow);
  for (const SceneSpark& spark : some(scene.sparks)) add_spark(frame, spark);
  for (const SceneVolume& shown : some(scene.volumes)) add_plane_frames(frame, shown);
  std::stable_sort(see_through.begin(), see_through.end(),
                   [](const DrawnBody& a, const DrawnBody& b) { return a.distance > b.distance; });
}

// The outlines of clipping planes within a volume.
void Marks::add_plane_frames(const Frame& frame, const SceneVolume& shown) {
  static constexpr Colour kPlane{0.95F, 0.55F, 0.10F, 1};
  if (shown.grid == nullptr || !sensible(shown.X_WV)) return;
  for (const VolumePlane& plane : shown.settings.planes) {
    if (!plane.framed) continue;
    const std::vector<Eigen::Vector3d> corners = volume::outline(plane, shown.grid->half_extent_m());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      hidden_by_bodies.line(frame.view, shown.X_WV * corners[i], shown.X_WV * corners[(i + 1) % corners.size()],
                            {kPlane, kPlane, 2.0F, false});
    }
  }
}

void Marks::add_axes(const Frame& frame, MeshStore& meshes, const SceneAxes& axes) {
  static constexpr std::array<Colour, 3> kColours = {Colour{0.80F, 0.16F, 0.12F, 1}, Colour{0.10F, 0.56F, 0.24F, 1},
                                                     Colour{0.10F, 0.34F, 0.84F, 1}};
  if (!sensible(axes.X_WF) || !(axes.length_m > 0) || axes.length_m > kFarthest) return;
  const Eigen::Vector3d origin = axes.X_WF.translation();
  const double pixel = frame.view.metres_per_pixel(frame.view.distance(origin));
  const float width = axes.emphasized ? 3.5F : 2.0F;
  const double head = std::min((axes.emphasized ? 14 : 10) * pixel, axes.length_m / 3);
  for (int i = 0; i < 3; ++i) {
    const Colour& colour = kColours[static_cast<std::size_t>(i)];
    const Eigen::Vector3d direction = axes.X_WF.linear().col(i);
    if (!(direction.norm() > 0.5)) continue;
    const Eigen::Vector3d end = origin + (axes.length_m - head) * direction;
    hidden_by_bodies.line(frame.view, origin, end, {colour, colour, width});
    // What is inside of a body shines through: frames of tools usually are.
    on_top.line(frame.view, origin, origin + axes.length_m * direction,
                {faded(colour, 0.28F), faded(colour, 0.28F), width});
    solids.push_back(solid_along(meshes.solid(Solid::cone), end, direction, head * 0.32, head, colour));
  }
}

void Marks::add_trace(const Frame& frame, const SceneTrace& trace) {
  const std::size_t count = std::min(trace.points.size(), kMostPoints);
  if (count < 2) return;
  const auto newest = std::span(trace.points).last(count);
  for (std::size_t i = 1; i < count; ++i) {
    const auto alpha = [&](std::size_t at) {
      const float part = static_cast<float>(at) / static_cast<float>(count - 1);
      return faded(trace.rgba, 0.12F + 0.88F * part);
    };
    hidden_by_bodies.line(frame.view, newest[i - 1].cast<double>(), newest[i].cast<double>(),
                          {alpha(i - 1), alpha(i), 2.5F});
  }
}

void Marks::add_cone(const Frame& frame, MeshStore& meshes, const SceneCone& cone) {
  constexpr double kWidest = 1.4;  // rad
  if (!sensible(cone.X_WS) || !(cone.half_angle_rad > 0) || !(cone.length_m > 0) || cone.length_m > kFarthest) return;
  const double angle = std::min(cone.half_angle_rad, kWidest);
  const double radius = cone.length_m * std::sin(angle);
  const double depth = cone.length_m * std::cos(angle);
  DrawnBody body;
  body.mesh = &meshes.solid(Solid::funnel);
  body.X_WM = cone.X_WS.matrix() * Eigen::Vector4d(radius, radius, depth, 1).asDiagonal();
  body.rgba = cone.rgba;
  body.distance = frame.view.distance(cone.X_WS * Eigen::Vector3d(0, 0, depth / 2));
  see_through.push_back(body);
  constexpr int kPieces = 48;
  const Colour rim = {cone.rgba[0] * 0.7F, cone.rgba[1] * 0.7F, cone.rgba[2] * 0.7F,
                      std::min(1.0F, cone.rgba[3] * 3.5F)};
  const auto on_rim = [&](int i) -> Eigen::Vector3d {
    const double turn = 2 * std::numbers::pi * i / kPieces;
    return cone.X_WS * Eigen::Vector3d(radius * std::cos(turn), radius * std::sin(turn), depth);
  };
  for (int i = 0; i < kPieces; ++i) hidden_by_bodies.line(frame.view, on_rim(i), on_rim(i + 1), {rim, rim, 1.5F});
  hidden_by_bodies.line(frame.view, cone.X_WS.translation(), cone.X_WS * Eigen::Vector3d(0, 0, depth),
                        {rim, rim, 1.2F, true});
}

void Marks::add_arrow(const Frame& frame, MeshStore& meshes, const SceneArrow& arrow) {
  const double length = arrow.along.norm();
  if (!sensible(arrow.from) || !sensible(arrow.along) || !(length > 1e-4)) return;
  const Eigen::Vector3d direction = arrow.along / length;
  const double pixel = frame.view.metres_per_pixel(frame.view.distance(arrow.from));
  const double shaft = std::max(std::min(0.018 * length, 0.02), 1.3 * pixel);
  const double head = std::min(7 * shaft, 0.45 * length);
  const double heads = arrow.torque ? 1.75 * head : head;
  DrawnBody body = solid_along(meshes.solid(Solid::cylinder), arrow.from + direction * (length - heads) / 2, direction,
                               shaft, std::max(length - heads, 1e-6), arrow.rgba);
  solids.push_back(body);
  StoredMesh& cone = meshes.solid(Solid::cone);
  const Eigen::Vector3d tip = arrow.from + arrow.along;
  // Forces act at frames within links: what bodies hide of an arrow shines through them, paler.
  const Colour pale = faded(arrow.rgba, 0.45F);
  const Ribbons::Style style{pale, pale, 2.0F};
  on_top.line(frame.view, arrow.from, tip - heads * direction, style);
  const auto add_head = [&](double behind_tip) {
    const Eigen::Vector3d end = tip - behind_tip * direction;
    solids.push_back(solid_along(cone, end - head * direction, direction, kHeadRadius * head, head, arrow.rgba));
    outline_head(frame, end, direction, head, style, on_top);
  };
  add_head(0);
  if (arrow.torque) add_head(heads - head);
}

void Marks::add_spark(const Frame& frame, const SceneSpark& spark) {
  if (!sensible(spark.at)) return;
  const double distance = frame.view.distance(spark.at);
  if (!(distance > 0)) return;
  const double pixel = frame.view.metres_per_pixel(distance);
  const double extent = (frame.scene.floor_high - frame.scene.floor_low).norm();
  const double reach = std::max(std::min(0.09, 0.02 * (std::isfinite(extent) ? extent : 1.0)), 10 * pixel);
  std::uint32_t dice = spark.phase * 2654435761U + 12345U;
  const auto roll = [&dice] {  // 0 to 1; the same for the same phase, so that pictures can be compared
    dice = dice * 1664525U + 1013904223U;
    return static_cast<double>(dice >> 8U) / static_cast<double>(1U << 24U);
  };
  const double flicker = 0.75 + 0.5 * roll();
  on_top.glow(frame.view, spark.at, flicker * reach / pixel, {0.45F, 0.66F, 1.0F, 0.75F});
  constexpr int kRays = 11;
  const Eigen::Matrix3d R_WE = frame.view.X_WE().linear();
  for (int i = 0; i < kRays; ++i) {
    const double turn = 2 * std::numbers::pi * (i + 0.7 * roll()) / kRays;
    const Eigen::Vector3d ray =
        R_WE * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0) * reach * (0.35 + 0.75 * roll());
    const Colour& hot = palette::kSpark;
    on_top.line(frame.view, spark.at, spark.at + ray, {hot, faded(hot, 0.0F), 2.2F});
  }
  on_top.glow(frame.view, spark.at, 0.42 * flicker * reach / pixel, {1, 1, 1, 1});
}

}  // namespace cellmirror::display
