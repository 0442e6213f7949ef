#include "tests/unit/display/test_scenes.hpp"

#include <cmath>
#include <numbers>

#include "rt_core/geometry/shape.hpp"
#include "rt_core/ports/palette.hpp"

namespace cellmirror::display {

namespace {

SceneBody& add(Scene& scene, Shape shape, const Eigen::Vector3d& size, const Pose& X_WG) {
  SceneBody& body = scene.bodies.emplace_back();
  body.object = static_cast<std::uint32_t>(scene.bodies.size());
  body.shape = shape;
  body.size = size;
  body.X_WG = X_WG;
  return body;
}

// From `from` to `to`, with rounded ends.
void add_link(Scene& scene, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius, Mark mark,
              const Colour& colour) {
  Pose X_WG = Pose::Identity();
  X_WG.translation() = (from + to) / 2;
  X_WG.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), to - from).toRotationMatrix();
  SceneBody& body = add(scene, Shape::capsule, {radius, (to - from).norm(), 0}, X_WG);
  body.mark = mark;
  body.rgba = colour;
}

void add_arm(Scene& scene, const Eigen::Vector3d& base, double turn, double reach, Mark mark, const Colour& colour) {
  const Eigen::Vector3d out(std::cos(turn), std::sin(turn), 0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  add(scene, Shape::cylinder, {0.20, 0.16, 0}, at(base.x(), base.y(), base.z() + 0.08)).mark = mark;
  add(scene, Shape::cylinder, {0.13, 0.45, 0}, at(base.x(), base.y(), base.z() + 0.38)).mark = mark;
  const Eigen::Vector3d shoulder = base + 0.65 * up;
  const Eigen::Vector3d elbow = shoulder + 0.25 * out + 0.65 * up;
  const Eigen::Vector3d wrist = elbow + reach * out - 0.15 * up;
  const Eigen::Vector3d tool = wrist + 0.05 * out - 0.22 * up;
  add_link(scene, shoulder, elbow, 0.095, mark, colour);
  add_link(scene, elbow, wrist, 0.07, mark, colour);
  add_link(scene, wrist, tool, 0.045, mark, {0.35F, 0.36F, 0.38F, 1});
  add(scene, Shape::sphere, {0.13, 0, 0}, at(shoulder.x(), shoulder.y(), shoulder.z())).mark = mark;
  add(scene, Shape::sphere, {0.10, 0, 0}, at(elbow.x(), elbow.y(), elbow.z())).mark = mark;
}

void add_surroundings(Scene& scene) {
  SceneBody& table = add_box(scene, {1.1, 0.7, 0.06}, at(0.55, -0.1, 0.62));
  table.rgba = {0.62F, 0.55F, 0.46F, 1};
  for (const double x : {0.08, 1.02}) {
    for (const double y : {-0.38, 0.18})
      add_box(scene, {0.06, 0.06, 0.59}, at(x, y, 0.295)).rgba = {0.4F, 0.4F, 0.42F, 1};
  }
  add_box(scene, {0.18, 0.14, 0.12}, at(0.72, -0.22, 0.71, 0.4)).mark = Mark::touching;
  add_mesh(scene, torus(0.11, 0.035, 48, 24), at(0.42, -0.2, 0.69)).rgba = {0.2F, 0.45F, 0.62F, 1};
  add_box(scene, {0.5, 0.45, 1.5}, at(-1.25, 1.1, 0.75)).rgba = {0.55F, 0.62F, 0.58F, 1};
  SceneBody& guard = add_box(scene, {2.4, 0.03, 1.4}, at(0.9, 1.35, 0.7));
  guard.mode = DrawMode::transparent;
  guard.rgba = {0.55F, 0.75F, 0.85F, 1};
  SceneBody& fence = add_box(scene, {0.03, 1.6, 1.4}, at(2.1, 0.5, 0.7));
  fence.mode = DrawMode::wireframe;
}

void add_findings(Scene& scene) {
  scene.axes.push_back({at(0.0, -0.9, 0.0), 0.35, false, "World"});
  scene.axes.push_back({at(0.62, -0.14, 0.93), 0.2, true, "TCP"});
  scene.lines.push_back({{0.72, -0.22, 0.77}, {0.66, -0.14, 0.93}, palette::kNear, 2.5F, false, true});
  scene.lines.push_back({{-0.6, -0.6, 0}, {-0.6, 0.2, 1.2}, {0.2F, 0.2F, 0.25F, 1}, 1.5F, true, false});
  SceneTrace& trace = scene.traces.emplace_back();
  trace.rgba = palette::kTrace;
  for (int i = 0; i < 120; ++i) {
    const float t = static_cast<float>(i) / 120;
    trace.points.emplace_back(-0.9F + 1.5F * t, -0.5F + 0.36F * t, 1.0F + 0.25F * std::sin(9 * t));
  }
  SceneCone cone;
  cone.X_WS = at(-1.25, 0.85, 1.2);
  cone.X_WS.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  cone.half_angle_rad = 0.22;
  cone.length_m = 1.3;
  cone.rgba = palette::kRange;
  scene.cones.push_back(cone);
  scene.arrows.push_back({{0.62, -0.14, 0.93}, {0.25, 0, 0.25}, palette::kForce, false});
  scene.arrows.push_back({{-0.9, 0, 1.3}, {0, 0, 0.4}, palette::kTorque, true});
  scene.sparks.push_back({{0.55, -0.3, 0.66}, 3});
}

void add_words(Scene& scene) {
  scene.labels.push_back({{0.7, -0.22, 0.85}, "3.1 mm", Mark::near});
  scene.labels.push_back({{0.72, -0.22, 0.66}, "workpiece: touching", Mark::touching});
  scene.labels.push_back({{-0.9, 0.1, 1.55}, "MANTEC_R3: 12.4 s old", Mark::ghost});
  scene.labels.push_back({{-1.25, -0.2, 1.2}, "US_2: 1.28 m", Mark::none});
  scene.legend = {{palette::kNear, "nearer than 50 mm"},
                  {palette::kTouching, "touching"},
                  {palette::kGhost, "no fresh data"},
                  {palette::kForce, "force, 100 N/m"},
                  {palette::kTrace, "trace of the TCP"}};
  scene.messages = {"Workpiece clamped", "Ready for the next one"};
}

}  // namespace

Pose at(double x, double y, double z, double yaw) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

SceneBody& add_box(Scene& scene, const Eigen::Vector3d& edges, const Pose& X_WG) {
  return add(scene, Shape::box, edges, X_WG);
}

SceneBody& add_mesh(Scene& scene, std::shared_ptr<const geometry::TriangleMesh> mesh, const Pose& X_WG) {
  SceneBody& body = add(scene, Shape::mesh, Eigen::Vector3d::Ones(), X_WG);
  body.mesh = std::move(mesh);
  return body;
}

Pane pane_looking_at(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& lookpoint, double opening_angle) {
  Pane pane;
  const Eigen::Vector3d z = (viewpoint - lookpoint).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitZ().cross(z).normalized();
  pane.eye.X_WE.translation() = viewpoint;
  pane.eye.X_WE.linear() << x, z.cross(x), z;
  pane.eye.opening_angle = opening_angle;
  return pane;
}

std::shared_ptr<const geometry::TriangleMesh> torus(double radius, double thickness, unsigned around, unsigned across) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  mesh->closed = true;
  for (unsigned i = 0; i < around; ++i) {
    for (unsigned j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around;
      const double v = 2 * std::numbers::pi * j / across;
      const double out = radius + thickness * std::cos(v);
      mesh->vertices.emplace_back(out * std::cos(u), out * std::sin(u), thickness * std::sin(v));
      const auto index = [&](unsigned a, unsigned b) { return (a % around) * across + b % across; };
      mesh->triangles.push_back({index(i, j), index(i + 1, j), index(i, j + 1)});
      mesh->triangles.push_back({index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return mesh;
}

Scene gallery_scene() {
  Scene scene;
  add_surroundings(scene);
  add_arm(scene, {-0.15, 0.55, 0}, -0.75, 0.60, Mark::none, {0.93F, 0.55F, 0.20F, 1});
  add_arm(scene, {-0.95, -0.1, 0}, 0.5, 0.55, Mark::ghost, {0.80F, 0.82F, 0.84F, 1});
  add_arm(scene, {1.45, 0.55, 0}, 3.6, 0.42, Mark::near, {0.85F, 0.86F, 0.88F, 1});
  add_findings(scene);
  add_words(scene);
  scene.floor_low = {-2, -1.5};
  scene.floor_high = {2.5, 1.6};
  scene.modes.set(static_cast<std::size_t>(DisplayMode::floor));
  scene.modes.set(static_cast<std::size_t>(DisplayMode::shadows));
  scene.modes.set(static_cast<std::size_t>(DisplayMode::antialiasing));
  scene.modes.set(static_cast<std::size_t>(DisplayMode::visibility_test));
  return scene;
}

Pane gallery_pane() { return pane_looking_at({1.6, -4.2, 2.3}, {0.3, 0.1, 0.65}, 0.62); }

}  // namespace cellmirror::display
