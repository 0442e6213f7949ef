// Light barriers of a small cell: a bar that turns through the beam, housings at its ends, frames that move.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/ranging/range_finder.hpp"

namespace cellmirror {
namespace {

using Eigen::Vector3d;

ComponentNode frame_at(const std::string& name, int parent, const Vector3d& at) {
  ComponentNode out;
  out.name = name;
  out.parent = parent;
  out.X_PF = pose_from_xyz_rpy(at, Vector3d::Zero());
  return out;
}

Geometry box_of(const Vector3d& size, const Vector3d& at = Vector3d::Zero()) {
  Geometry out;
  out.shape = Shape::box;
  out.size = size;
  out.X_NG.translation() = at;
  return out;
}

class OneComponent final : public ComponentSource {
 public:
  explicit OneComponent(std::shared_ptr<const Component> component) : component_(std::move(component)) {}
  Result<std::shared_ptr<const Component>> component(std::string_view) override { return component_; }

 private:
  std::shared_ptr<const Component> component_;
};

// A bar of 1 m along x that turns about z at the world's origin, and a beam along y at x = 0.5, from y = 0.2 to 2.
struct Barriers : testing::Test {
  Barriers() {
    bar = std::make_shared<Component>();
    bar->file = "bar.mpc";
    ComponentNode turn = frame_at("TURN", -1, Vector3d::Zero());
    turn.kind = NodeKind::joint;
    turn.joint = JointDefinition{};
    turn.joint->min_position = -3.2;
    turn.joint->max_position = 3.2;
    turn.joint->max_velocity = 1.0;
    turn.joint->max_acceleration = 1.0;
    turn.geometry.push_back(box_of({1.0, 0.1, 0.1}, {0.5, 0, 0}));
    bar->nodes.push_back(turn);
    bar->nodes.push_back(frame_at("TIP", 0, {1.0, 0, 0}));
    RobotDefinition robot;
    robot.id = "BAR";
    robot.flange = 1;
    robot.joints = {0};
    bar->robot = robot;
    root.file = "cell.toml";
    root.nodes.push_back(frame_at("FOOT", -1, Vector3d::Zero()));
    root.nodes.back().abstract = AbstractReference{};
    root.nodes.back().abstract->file = "bar.mpc";
    root.nodes.push_back(frame_at("EMITTER", -1, {0.5, 0.2, 0}));
    root.nodes.push_back(frame_at("RECEIVER", -1, {0.5, 2.0, 0}));
  }

  BarrierReading at(double q) {
    if (!sut) {
      Diagnostics diagnostics;
      cell = Cell::build(std::make_shared<const Component>(root), std::make_shared<OneComponent>(bar), diagnostics);
      EXPECT_TRUE(cell) << diagnostics.text();
      compiled = cell->compile();
      poses = {};  // a cell of its own with, perhaps, the revision of the one before
      sut.emplace(std::make_shared<geometry::SolidLibrary>(), std::vector{barrier});
      sut->adopt(compiled);
    }
    auto values = cell->start_positions();
    values[0][0] = q;
    compute_poses(*compiled, values, poses);
    static_cast<void>(sut->read(poses, kNow, ranging::Selection::active_sensors));
    const auto found = sut->read_barriers(poses, kNow);
    EXPECT_EQ(found.size(), 1U);
    return found[0];
  }

  static constexpr Timestamp kNow{1'000};
  Component root;
  std::shared_ptr<Component> bar;
  LightBarrier barrier{.name = "gate", .from = "EMITTER", .to = "RECEIVER", .radius = 0.005};
  std::optional<Cell> cell;
  std::shared_ptr<const CompiledCell> compiled;
  CellPoses poses;
  std::optional<ranging::RangeFinder> sut;
};

TEST_F(Barriers, ABodyInTheBeamInterruptsIt) {
  const BarrierReading free = at(0);
  EXPECT_FALSE(free.interrupted);
  EXPECT_TRUE(free.object.empty());
  EXPECT_FALSE(free.doubtful);
  EXPECT_EQ(free.name, "gate");
  EXPECT_EQ(free.posture_time, kNow);
  const BarrierReading cut = at(0.8);
  EXPECT_TRUE(cut.interrupted);
  EXPECT_EQ(cut.object, "FOOT.TURN");
  EXPECT_FALSE(at(std::numbers::pi / 2).interrupted) << "beyond it";
}

// The bar's upper edge is at y = 0.05 for q = 0; the beam's end is 0.15 m above it.
TEST_F(Barriers, TheBeamEndsAtItsFramesAndHasAWidth) {
  root.nodes[1].X_PF = pose_from_xyz_rpy({0.5, 0.0501, 0}, Vector3d::Zero());
  EXPECT_FALSE(at(0).interrupted) << "flat ends";
  sut.reset();
  root.nodes[1].X_PF = pose_from_xyz_rpy({1.004, -1, 0}, Vector3d::Zero());
  root.nodes[2].X_PF = pose_from_xyz_rpy({1.004, 1, 0}, Vector3d::Zero());
  EXPECT_TRUE(at(0).interrupted) << "5 mm around the axis";
  sut.reset();
  barrier.radius = 0.003;
  EXPECT_FALSE(at(0).interrupted);
}

TEST_F(Barriers, HousingsDoNotInterruptTheirOwnBeam) {
  root.nodes[1].geometry.push_back(box_of({0.1, 0.1, 0.1}));
  root.nodes[2].geometry.push_back(box_of({0.1, 0.1, 0.1}));
  EXPECT_FALSE(at(0).interrupted);
  EXPECT_TRUE(at(0.8).interrupted);
}

TEST_F(Barriers, InterruptionsAreCounted) {
  EXPECT_EQ(at(0).interruptions, 0U);
  EXPECT_EQ(at(0.8).interruptions, 1U);
  EXPECT_EQ(at(0.81).interruptions, 1U) << "still the same";
  EXPECT_EQ(at(0).interruptions, 1U);
  sut->adopt(compiled);
  EXPECT_EQ(at(0.8).interruptions, 2U) << "also where the cell has changed";
}

TEST_F(Barriers, TellsWhereItsEndsAre) {
  const BarrierReading reading = at(0.8);
  ASSERT_TRUE(reading.placed);
  EXPECT_EQ(reading.from, Vector3d(0.5, 0.2, 0));
  EXPECT_EQ(reading.to, Vector3d(0.5, 2.0, 0));
  EXPECT_FALSE(reading.short_object.empty());
}

TEST_F(Barriers, AnEndMayMove) {
  barrier.from = "FOOT.TURN.TIP";
  root.nodes.push_back(frame_at("POST", -1, {0.75, 1.0, 0}));
  root.nodes.back().geometry.push_back(box_of({0.1, 0.1, 0.1}));
  EXPECT_TRUE(at(0).interrupted) << "from the tip at (1, 0) to (0.5, 2) through (0.75, 1)";
  EXPECT_EQ(at(0).object, "POST");
  EXPECT_FALSE(at(2.0).interrupted);
}

TEST_F(Barriers, WhatIsNotKnownCountsAsInterrupted) {
  barrier.to = "NOT.THERE";
  const BarrierReading missing = at(0);
  EXPECT_TRUE(missing.interrupted);
  EXPECT_TRUE(missing.doubtful);
  EXPECT_FALSE(missing.placed);
  sut.reset();
  barrier.to = "RECEIVER";
  barrier.from = "FOOT.TURN.TIP";
  const BarrierReading lost = at(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(lost.interrupted);
  EXPECT_TRUE(lost.doubtful);
}

}  // namespace
}  // namespace cellmirror
