// The trace of a TCP: few points that stay on the path, whatever the rate of the samples, and what SMEAR makes of it.
#include "app/workers/trace_worker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <thread>

#include "app/workers/trace_recorder.hpp"
#include "rt_core/rt/broadcast.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::app {
namespace {

Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

double length_of(const TcpTrace& trace) {
  double length = 0;
  for (std::size_t i = 1; i < trace.points.size(); ++i)
    length += static_cast<double>((trace.points[i] - trace.points[i - 1]).norm());
  return length;
}

TEST(TraceRecorder, ALineTakesFewPointsAndAnArcStaysAnArc) {
  TraceRecorder sut;
  for (int i = 0; i <= 200; ++i) sut.extend("ARM", at(0.001 * i, 0, 0));
  EXPECT_EQ(sut.traces().at(0).points.size(), 2U);
  sut.clear();
  constexpr double kRadius = 0.9;
  constexpr double kAngle = std::numbers::pi / 3;
  for (int i = 0; i <= 500; ++i) {
    const double angle = kAngle * i / 500;
    sut.extend("ARM", at(kRadius * std::cos(angle), kRadius * std::sin(angle), 0));
  }
  const TcpTrace trace = sut.traces().at(0);
  EXPECT_NEAR(length_of(trace), kRadius * kAngle, 1e-3);
  EXPECT_LT(trace.points.size(), 60U);
  // Between its points, too, the polyline stays on the arc.
  for (std::size_t i = 1; i < trace.points.size(); ++i) {
    const Eigen::Vector3f middle = (trace.points[i] + trace.points[i - 1]) / 2;
    EXPECT_NEAR(middle.norm(), kRadius, TraceRecorder::kTolerance + 1e-6);
  }
  EXPECT_LT(
      (trace.points.back().cast<double>() - at(kRadius * 0.5, kRadius * std::sin(kAngle), 0).translation()).norm(),
      1e-6)
      << "up to where the robot is";
}

TEST(TraceRecorder, StandingStillAndWhatIsNoPoseAreNoChange) {
  TraceRecorder sut;
  EXPECT_TRUE(sut.extend("ARM", at(1, 0, 0)));
  EXPECT_FALSE(sut.extend("ARM", at(1, 0, 0)));
  EXPECT_FALSE(sut.extend("ARM", at(std::numeric_limits<double>::quiet_NaN(), 0, 0)));
  EXPECT_EQ(sut.traces().at(0).points.size(), 1U);
}

TEST(TraceRecorder, KeepsFramesWhereTheTcpTurnsOrMovesOn) {
  TraceRecorder sut;
  for (int i = 0; i <= 100; ++i) {
    Pose X = at(0, 0, 0);
    X.rotate(Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d::UnitZ()));
    sut.extend("ARM", X);
  }
  EXPECT_EQ(sut.traces().at(0).points.size(), 1U);
  EXPECT_NEAR(static_cast<double>(sut.traces().at(0).frames.size()), 1.0 / TraceRecorder::kFrameTurn, 1.5);
  for (int i = 0; i <= 100; ++i) sut.extend("LIFT", at(0, 0, 0.01 * i));
  EXPECT_NEAR(static_cast<double>(sut.traces().at(1).frames.size()), 1.0 / TraceRecorder::kFrameStep, 1.5);
}

TEST(TraceRecorder, StaysBounded) {
  TraceRecorder sut;
  for (std::size_t i = 0; i < 2 * TraceRecorder::kPoints; ++i)
    sut.extend("ARM", at(0.001 * static_cast<double>(i), i % 2 == 0 ? 0.0 : 0.01, 0));
  EXPECT_LE(sut.traces().at(0).points.size(), TraceRecorder::kPoints + 1);
  EXPECT_LE(sut.traces().at(0).frames.size(), TraceRecorder::kFrames);
  for (int i = 0; i < 20; ++i) sut.extend("R" + std::to_string(i), at(0, 0, 0));
  EXPECT_EQ(sut.traces().size(), TraceRecorder::kTraces);
  EXPECT_EQ(sut.traces().back().robot, "R19");
}

// Ticks by hand, a millisecond apart: kArm's second joint turns its tip about x = 1 m.
struct TraceWorkerTest : testing::Test {
  TraceWorkerTest() {
    auto files = std::make_shared<TextFiles>();
    files->add("arm.mpc", kArm);
    Diagnostics diagnostics;
    cell = build_cell("[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n", files, diagnostics);
    EXPECT_TRUE(cell) << diagnostics.text();
  }
  void show(bool smear, std::uint64_t ends = 0) {
    auto display = std::make_shared<DisplayState>();
    display->modes.set(static_cast<std::size_t>(DisplayMode::smear), smear);
    display->smear_ends = ends;
    auto cell_state = std::make_shared<CellState>();
    cell_state->cell = cell->compile();
    cell_state->display = display;
    cell_state->active_robot = "ARM";
    board.publish(cell_state);
  }
  void turn(double angle) {
    engine::TickState& state = ticks.writable();
    state = engine::TickState{8};
    engine::RobotTickState& arm = state.robots[cell->robot("ARM")->slot()];
    arm.mode = engine::RobotMode::simulated;
    arm.joint_count = static_cast<std::uint8_t>(cell->robot("ARM")->joints().size());
    arm.joints[1].position = angle;
    state.tick = ++tick;
    state.time = clock.now();
    ticks.publish();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  // Goes on with ticks that stand still.
  bool eventually(double angle, const std::function<bool(const TraceState&)>& condition) {
    for (int i = 0; i < 20000; ++i) {
      const auto state = sut.board().latest();
      if (state && condition(*state)) return true;
      turn(angle);
    }
    return false;
  }

  SystemClock clock;
  std::optional<Cell> cell;
  Board<CellState> board;
  Broadcast<engine::TickState> ticks;
  engine::TickReader reader{"test", ticks.subscribe()};
  std::uint64_t tick = 0;
  TraceWorker sut{reader, board, clock, std::chrono::milliseconds(1)};
};

TEST_F(TraceWorkerTest, RecordsTicksWhileSmearIsOnAndForgetsThemAfterwards) {
  show(true);
  ASSERT_TRUE(eventually(0, [](const TraceState& state) { return state.traces.size() == 1; }));
  EXPECT_EQ(sut.board().latest()->traces[0].robot, "ARM");
  constexpr double kAngle = 1.0;
  for (int i = 0; i <= 100; ++i) turn(kAngle * i / 100);
  const auto arrived = [&](const TraceState& state) {
    const auto& points = state.traces.at(0).points;
    return points.size() > 1 && std::abs(std::atan2(points.back().y(), points.back().x() - 1.0F) - 1.0F) < 1e-4F;
  };
  ASSERT_TRUE(eventually(kAngle, arrived));
  // Off and on again between two looks: another trace.
  show(true, 1);
  ASSERT_TRUE(eventually(kAngle, [](const TraceState& state) {
    return state.smear_ends == 1 && state.traces.size() == 1 && state.traces[0].points.size() == 1;
  }));
  show(false, 2);
  EXPECT_TRUE(eventually(kAngle, [](const TraceState& state) { return state.traces.empty(); }));
}

}  // namespace
}  // namespace cellmirror::app
