// Sensors of a small cell: on a turning arm, within their housing, on poles, switched on and off.
#include "rt_core/ranging/range_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/cell.hpp"

namespace cellmirror {
namespace {

using Eigen::Vector3d;
using ranging::Selection;

constexpr Timestamp kNow{1'000};

Geometry box(const Vector3d& size, const Vector3d& at = Vector3d::Zero()) {
  Geometry out;
  out.shape = Shape::box;
  out.size = size;
  out.X_NG.translation() = at;
  return out;
}

Geometry ball(double radius) {
  Geometry out;
  out.shape = Shape::sphere;
  out.size = {radius, 0, 0};
  return out;
}

ComponentNode node(const std::string& name, int parent, const Pose& X_PF) {
  ComponentNode out;
  out.name = name;
  out.parent = parent;
  out.X_PF = X_PF;
  return out;
}

ComponentNode sensor(const std::string& name, int parent, const Pose& X_PF) {
  ComponentNode out = node(name, parent, X_PF);
  out.kind = NodeKind::sensor;
  out.sensor.half_angle_rad = 0.1;
  out.sensor.active = true;
  return out;
}

Pose looking_along_x(const Vector3d& at = Vector3d::Zero()) {
  return pose_from_xyz_rpy(at, {0, 0.5 * std::numbers::pi, 0});
}

std::shared_ptr<const geometry::TriangleMesh> mesh_of_plate(double x, double half) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  mesh->vertices = {{x, -half, -half}, {x, half, -half}, {x, half, half}, {x, -half, half}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

class OneArm final : public ComponentSource {
 public:
  explicit OneArm(std::shared_ptr<const Component> arm) : arm_(std::move(arm)) {}
  Result<std::shared_ptr<const Component>> component(std::string_view) override { return arm_; }

 private:
  std::shared_ptr<const Component> arm_;
};

// A bar of 1 m along x, turning about z at the arm's foot; its sensor at the end looks along the bar.
std::shared_ptr<Component> arm() {
  auto out = std::make_shared<Component>();
  out->file = "arm.mpc";
  ComponentNode turn = node("TURN", -1, Pose::Identity());
  turn.kind = NodeKind::joint;
  turn.joint = JointDefinition{};
  turn.joint->min_position = -3.2;
  turn.joint->max_position = 3.2;
  turn.joint->max_velocity = 1.0;
  turn.joint->max_acceleration = 1.0;
  turn.geometry.push_back(box({1.0, 0.1, 0.1}, {0.5, 0, 0}));
  out->nodes.push_back(turn);
  out->nodes.push_back(node("TIP", 0, pose_from_xyz_rpy({1.0, 0, 0}, Vector3d::Zero())));
  out->nodes.push_back(sensor("EYE", 1, looking_along_x()));
  RobotDefinition robot;
  robot.id = "ARM";
  robot.flange = 1;
  robot.joints = {0};
  out->robot = robot;
  return out;
}

struct Scene {
  Component root;
  std::shared_ptr<Component> arm = cellmirror::arm();

  Scene() {
    root.file = "cell.toml";
    ComponentNode foot = node("FOOT", -1, Pose::Identity());
    foot.abstract = AbstractReference{};
    foot.abstract->file = "arm.mpc";
    root.nodes.push_back(foot);
  }
  [[nodiscard]] Cell build() const {
    Diagnostics diagnostics;
    auto cell = Cell::build(std::make_shared<const Component>(root), std::make_shared<OneArm>(arm), diagnostics);
    EXPECT_TRUE(cell.has_value()) << diagnostics.text();
    return std::move(*cell);
  }
  ComponentNode& eye() { return arm->nodes[2]; }
};

class Ranging : public testing::Test {
 public:
  Scene scene;
  CellPoses poses;
  ranging::RangeFinder sut{std::make_shared<geometry::SolidLibrary>()};

  std::span<const RangeReading> read(double q = 0.0, Selection selection = Selection::active_sensors) {
    if (!cell_) cell_.emplace(scene.build());
    adopt();
    auto values = cell_->start_positions();
    values[0][0] = q;
    compute_poses(*compiled_, values, poses);
    return sut.read(poses, kNow, selection);
  }
  void adopt() {
    const auto now = cell_->compile();
    if (now == compiled_) return;
    compiled_ = now;
    sut.adopt(now);
  }

 protected:
  std::optional<Cell> cell_;
  std::shared_ptr<const CompiledCell> compiled_;
};

TEST_F(Ranging, follows_the_robot_that_bears_the_sensor) {
  scene.root.nodes.push_back(node("WALL", -1, pose_from_xyz_rpy({3.0, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({0.2, 20.0, 20.0}));
  for (const double q : {0.0, 0.05, 0.3, -0.6}) {
    const auto readings = read(q);
    ASSERT_EQ(readings.size(), 1U);
    const double to_wall = 2.9 - std::cos(q);  // from the apex, at a right angle
    const double beam = std::max(0.0, std::abs(q) - 0.1);
    ASSERT_TRUE(readings[0].distance_m) << q;
    EXPECT_NEAR(*readings[0].distance_m, to_wall / std::cos(beam), 1e-12) << q;
    EXPECT_NEAR(readings[0].point_m.x(), 2.9, 1e-12);
    EXPECT_EQ(readings[0].id, "EYE");
    EXPECT_EQ(readings[0].object, "WALL");
    EXPECT_EQ(readings[0].path, "FOOT.TURN.TIP.EYE");
    EXPECT_EQ(readings[0].posture_time, kNow);
    EXPECT_FALSE(readings[0].doubtful);
    EXPECT_FALSE(readings[0].in_blind_zone);
  }
  EXPECT_FALSE(read(2.0)[0].distance_m);
  EXPECT_TRUE(read(2.0)[0].object.empty());
}

TEST_F(Ranging, sees_the_robot_pass_a_sensor_that_stands_still) {
  scene.root.nodes.push_back(sensor("POLE", -1, looking_along_x({-2.0, 0, 0})));
  scene.eye().sensor.active = false;
  EXPECT_NEAR(*read(0.0)[0].distance_m, 2.0, 1e-12);
  EXPECT_NEAR(*read(std::numbers::pi)[0].distance_m, 1.0, 1e-12);
  EXPECT_EQ(read(0.0)[0].object, "FOOT.TURN");
}

TEST_F(Ranging, does_not_see_its_own_housing_but_other_geometry_of_the_same_body) {
  // The bar ends at the apex; a flag on the same link stands before it.
  EXPECT_FALSE(read()[0].distance_m);
  cell_.reset();
  scene.arm->nodes[1].geometry.push_back(box({0.3, 0.3, 0.3}));  // around the apex
  EXPECT_FALSE(read()[0].distance_m);
  cell_.reset();
  scene.arm->nodes[1].geometry.push_back(box({0.02, 0.5, 0.5}, {0.8, 0, 0}));
  ASSERT_TRUE(read()[0].distance_m);
  EXPECT_NEAR(*read()[0].distance_m, 0.79, 1e-12);
  EXPECT_EQ(read()[0].object, "FOOT.TURN.TIP");
}

TEST_F(Ranging, sees_what_is_around_it_but_not_joined_with_it) {
  scene.root.nodes.push_back(node("BUBBLE", -1, pose_from_xyz_rpy({1.0, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(ball(0.5));
  ASSERT_TRUE(read()[0].distance_m);
  EXPECT_NEAR(*read()[0].distance_m, 0.5, 1e-12);
}

TEST_F(Ranging, reads_things_in_the_blind_zone_exactly_and_says_so) {
  scene.eye().sensor.blind_zone_m = 0.2;
  scene.root.nodes.push_back(node("THING", -1, pose_from_xyz_rpy({1.15, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({0.1, 0.1, 0.1}));
  const auto readings = read();
  EXPECT_NEAR(*readings[0].distance_m, 0.1, 1e-12);
  EXPECT_TRUE(readings[0].in_blind_zone);
}

TEST_F(Ranging, reaches_to_the_end_of_the_range_and_not_beyond) {
  scene.root.nodes.push_back(node("WALL", -1, pose_from_xyz_rpy({2.1, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({0.2, 1.0, 1.0}));
  scene.eye().sensor.range_m = 1.0;
  ASSERT_TRUE(read()[0].distance_m);
  EXPECT_NEAR(*read()[0].distance_m, 1.0, 1e-12);
  EXPECT_LE(*read()[0].distance_m, 1.0);
  cell_.reset();
  scene.eye().sensor.range_m = 1.0 - 1e-9;
  EXPECT_FALSE(read()[0].distance_m);
}

TEST_F(Ranging, sees_only_what_is_active_and_collides) {
  scene.root.nodes.push_back(node("WALL", -1, pose_from_xyz_rpy({3.0, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({0.2, 1.0, 1.0}));
  ComponentNode picture = node("PICTURE", -1, pose_from_xyz_rpy({2.0, 0, 0}, Vector3d::Zero()));
  picture.geometry.push_back(box({0.2, 1.0, 1.0}));
  picture.geometry.back().collides = false;
  scene.root.nodes.push_back(picture);
  EXPECT_EQ(read()[0].object, "WALL");
  ASSERT_TRUE(cell_->deactivate("WALL"));
  EXPECT_FALSE(read()[0].distance_m);
  ASSERT_TRUE(cell_->activate("WALL"));
  EXPECT_TRUE(read()[0].distance_m);
}

TEST_F(Ranging, sees_the_mesh_itself_where_a_hull_collides_for_it) {
  scene.root.nodes.push_back(node("CASTING", -1, Pose::Identity()));
  Geometry casting;
  casting.shape = Shape::mesh;
  casting.size = Vector3d::Ones();
  casting.mesh = mesh_of_plate(3.0, 1.0);
  casting.collide_as = CollideAs::hull;
  casting.pieces = {mesh_of_plate(2.0, 1.0)};
  scene.root.nodes.back().geometry.push_back(casting);
  EXPECT_NEAR(*read()[0].distance_m, 2.0, 1e-12);
  cell_.reset();
  scene.root.nodes.back().geometry.back().mesh = nullptr;
  EXPECT_NEAR(*read()[0].distance_m, 1.0, 1e-12);
  EXPECT_FALSE(read()[0].doubtful);
}

TEST_F(Ranging, does_not_depend_on_what_it_saw_before) {
  for (int i = 0; i < 60; ++i) {
    const double turn = 2.4 * i;
    const double out = 1.3 + 0.02 * i;
    const Pose X =
        pose_from_xyz_rpy({out * std::cos(turn), out * std::sin(turn), 0.1 * std::sin(5.0 * i)}, {1.0 * i, turn, 0});
    scene.root.nodes.push_back(node("THING_" + std::to_string(i), -1, X));
    Geometry thing = i % 2 == 0 ? ball(0.02) : box({0.05, 0.08, 0.02});
    if (i % 5 == 0) {
      thing.shape = Shape::mesh;
      thing.size = Vector3d::Ones();
      thing.mesh = mesh_of_plate(0.0, 0.1);
    }
    scene.root.nodes.back().geometry.push_back(thing);
  }
  scene.root.nodes.push_back(sensor("POLE", -1, looking_along_x({-3.0, 0, 0})));
  int seen = 0;
  for (int i = 0; i < 300; ++i) {
    const auto readings = read(0.02 * i - 3.0);
    ranging::RangeFinder fresh{std::make_shared<geometry::SolidLibrary>()};
    fresh.adopt(compiled_);
    const auto again = fresh.read(poses, kNow, Selection::active_sensors);
    for (std::size_t k = 0; k < readings.size(); ++k) {
      ASSERT_EQ(readings[k].distance_m.has_value(), again[k].distance_m.has_value()) << i;
      if (!readings[k].distance_m) continue;
      ++seen;
      EXPECT_NEAR(*readings[k].distance_m, *again[k].distance_m, 1e-14) << i;
      EXPECT_EQ(readings[k].object, again[k].object) << i;
    }
  }
  EXPECT_GT(seen, 300);
}

TEST_F(Ranging, reads_the_active_sensors_or_all_in_the_order_of_the_cell) {
  scene.root.nodes.push_back(sensor("A", -1, Pose::Identity()));
  scene.root.nodes.back().sensor.active = false;
  scene.root.nodes.push_back(sensor("B", -1, Pose::Identity()));
  EXPECT_EQ(read().size(), 2U);
  const auto all = read(0.0, Selection::all_sensors);
  ASSERT_EQ(all.size(), 3U);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].id, compiled_->sensors[i].name);
}

TEST_F(Ranging, has_the_same_noise_for_the_same_seed) {
  scene.root.nodes.push_back(node("WALL", -1, pose_from_xyz_rpy({3.0, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({2.0, 9.0, 9.0}));
  scene.eye().sensor.noise_m = 0.01;
  scene.eye().sensor.seed = 7;
  std::vector<double> first;
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kReadings = 4000;
  for (int i = 0; i < kReadings; ++i) {
    const double error = *read()[0].distance_m - 1.0;
    sum += error;
    squares += error * error;
    if (first.size() < 100) first.push_back(error);
  }
  EXPECT_NEAR(sum / kReadings, 0.0, 0.001);
  EXPECT_NEAR(std::sqrt(squares / kReadings), 0.01, 0.001);
  ranging::RangeFinder again{std::make_shared<geometry::SolidLibrary>()};
  again.adopt(compiled_);
  for (const double error : first) {
    EXPECT_EQ(*again.read(poses, kNow, Selection::all_sensors)[0].distance_m - 1.0, error);
  }
}

TEST_F(Ranging, keeps_the_noise_going_when_the_cell_changes) {
  scene.eye().sensor.noise_m = 0.01;
  scene.root.nodes.push_back(node("WALL", -1, pose_from_xyz_rpy({3.0, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({2.0, 9.0, 9.0}));
  const double first = *read()[0].distance_m;
  const Pose X = pose_from_xyz_rpy({3.0, 0, 0}, {1.0, 0, 0});
  ASSERT_TRUE(cell_->set_placement("WALL", X));
  EXPECT_NE(*read()[0].distance_m, first);
}

TEST_F(Ranging, with_noise_never_reads_below_zero_or_beyond_the_range) {
  scene.eye().sensor.noise_m = 0.5;
  scene.eye().sensor.range_m = 0.2;
  scene.root.nodes.push_back(node("WALL", -1, pose_from_xyz_rpy({1.2, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({0.2, 1.0, 1.0}));
  int none = 0;
  for (int i = 0; i < 500; ++i) {
    const auto& reading = read()[0];
    none += reading.distance_m ? 0 : 1;
    if (!reading.distance_m) continue;
    EXPECT_GE(*reading.distance_m, 0.0);
    EXPECT_LE(*reading.distance_m, 0.2);
  }
  EXPECT_GT(none, 100);
}

TEST_F(Ranging, hears_nothing_from_a_wall_that_is_too_oblique) {
  scene.eye().sensor.max_incidence_rad = 0.3;
  scene.root.nodes.push_back(node("WALL", -1, pose_from_xyz_rpy({3.0, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({2.0, 99.0, 99.0}));
  EXPECT_TRUE(read(0.39)[0].distance_m);
  EXPECT_FALSE(read(0.41)[0].distance_m);
}

TEST_F(Ranging, says_that_it_is_in_doubt_where_a_pose_is_no_number) {
  scene.root.nodes.push_back(node("WALL", -1, pose_from_xyz_rpy({3.0, 0, 0}, Vector3d::Zero())));
  scene.root.nodes.back().geometry.push_back(box({2.0, 9.0, 9.0}));
  scene.root.nodes.push_back(sensor("POLE", -1, looking_along_x({1.5, 0, 0})));
  (void)read();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto lost = read(nan);
  ASSERT_EQ(lost.size(), 2U);
  for (const RangeReading& reading : lost) {
    EXPECT_TRUE(reading.doubtful);
    EXPECT_EQ(reading.distance_m.has_value(), reading.id == "POLE");
  }
  for (const RangeReading& reading : read()) EXPECT_FALSE(reading.doubtful);
}

TEST_F(Ranging, says_that_it_is_in_doubt_where_a_mesh_was_not_read) {
  scene.root.nodes.push_back(node("SCAN", -1, Pose::Identity()));
  Geometry scan;
  scan.shape = Shape::mesh;
  scan.size = Vector3d::Ones();
  scene.root.nodes.back().geometry.push_back(scan);
  EXPECT_TRUE(read()[0].doubtful);
}

}  // namespace
}  // namespace cellmirror
