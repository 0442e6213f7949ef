// SCRIPT's motion commands on the transfer cell: the gateway's own desk and fleet, and the tick, driven by hand.
#include "app/owner/motion/motion_service.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "app/owner/fleet.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/motion/executor.hpp"
#include "rt_core/rt/watchdog.hpp"
#include "tests/unit/app/transfer_cell.hpp"

namespace cellmirror::app {
namespace {

constexpr std::string_view kMantec = "MANTEC_R3";

// As one of a CAN interface that the machine does not have.
struct StreamOfNothing final : JointStream {
  Result<void> open(JointSampleSink& /*sink*/) override { return fail("no such interface"); }
  void close() override {}
  [[nodiscard]] JointStreamStatus status() const override { return {}; }
};

class MotionDeskTest : public testing::Test {
 protected:
  MotionDeskTest() {
    EXPECT_TRUE(fleet_.follow_cell());
    tick();
  }

  void tick(int count = 1) {
    for (int i = 0; i < count; ++i) {
      clock_.advance(Nanoseconds(1'000'000));
      CycleContext context;
      context.now = context.scheduled = clock_.now();
      context.cycle = cycle_++;
      context.period = Nanoseconds(1'000'000);
      engine_->run(context);
      sut_.follow();
    }
  }
  void arrive(const Result<ActivityHandle>& moved) {
    ASSERT_TRUE(moved) << moved.error().text();
    for (int most = 60'000; sut_.moving() && most > 0; --most) tick();
    EXPECT_EQ((*moved)->state(), Activity::State::done) << (*moved)->error().text();
  }
  [[nodiscard]] double first_joint() { return fleet_.positions()[cell_.robot(kMantec)->slot()][0]; }

  Cell cell_ = transfer_cell();
  ManualClock clock_;
  Watchdog watchdog_{std::chrono::seconds(1), {}};
  std::unique_ptr<engine::Engine> engine_ = std::make_unique<engine::Engine>(watchdog_);
  Fleet fleet_{cell_, *engine_, {}, clock_, 0, {.device_stream = [](std::string_view) -> std::shared_ptr<JointStream> {
                 return std::make_shared<StreamOfNothing>();
               }}};
  NoNames names_;
  MotionService sut_{cell_, names_, [] { return Eigen::Matrix3d::Identity().eval(); }, fleet_, clock_};
  std::uint64_t cycle_ = 0;
};

TEST_F(MotionDeskTest, RobotThatCannotGoOnlineEndsItsMoveAndGoesStraightAfterwards) {
  constexpr std::array kBent = {0.1, 0.7, 1.4, 0.0, 0.5, 0.0};
  const auto bent = sut_.position(kMantec, {.mode = TargetMode::joint_abs, .joints = kBent});
  tick(20);
  const auto online = fleet_.set_online(kMantec, true);
  ASSERT_FALSE(online);
  EXPECT_NE(online.error().text().find("no such interface"), std::string::npos);
  arrive(bent);
  EXPECT_NEAR(first_joint(), kBent[0], 1e-9);
  arrive(sut_.position(kMantec,
                       {.mode = TargetMode::tool_inc, .joints = {}, .pose = Pose(Eigen::Translation3d(0, 0, 0.01))}));
}

TEST_F(MotionDeskTest, RobotBeginsAtItsStartPositionUntilSomethingHasMovedIt) {
  const JointValues start{0.2, 0.7, 1.4, 0.0, 0.5, 0.1};
  auto began = fleet_.begin_at(kMantec, start);
  ASSERT_TRUE(began && *began);
  EXPECT_EQ(first_joint(), 0.2) << "published before the tick has carried it out";
  tick();
  EXPECT_EQ(first_joint(), 0.2);
  JointValues corrected = start;
  corrected[0] = -0.3;
  began = fleet_.begin_at(kMantec, corrected);
  ASSERT_TRUE(began && *began) << "a start script may correct it";
  tick();
  constexpr std::array kIncrement = {0.01};
  arrive(sut_.position(kMantec, {.mode = TargetMode::joint_inc, .joints = kIncrement}));
  EXPECT_NEAR(first_joint(), -0.29, 1e-9);
  began = fleet_.begin_at(kMantec, start);
  ASSERT_TRUE(began);
  EXPECT_FALSE(*began);
  tick();
  EXPECT_NEAR(first_joint(), -0.29, 1e-9);
}

TEST_F(MotionDeskTest, RobotThatWasSetToAPositionHasBegun) {
  JointValues there{};
  there[0] = 0.4;
  ASSERT_TRUE(fleet_.jump(kMantec, there));
  const auto began = fleet_.begin_at(kMantec, {});
  ASSERT_TRUE(began);
  EXPECT_FALSE(*began);
  EXPECT_EQ(first_joint(), 0.4);
}

TEST_F(MotionDeskTest, EveryMoveThatIsAcceptedIsGoneThoughTheTickHasBegunNone) {
  constexpr std::array kIncrement = {0.001};
  const double from = first_joint();
  std::size_t accepted = 0;
  while (accepted < 1000 &&
         sut_.queue_move(kMantec, MovePath::joints, {.mode = TargetMode::joint_inc, .joints = kIncrement})) {
    ++accepted;
  }
  EXPECT_EQ(accepted, motion::kMoveQueue);
  for (int most = 60'000; sut_.moving() && most > 0; --most) tick();
  EXPECT_NEAR(first_joint(), from + static_cast<double>(accepted) * kIncrement[0], 1e-9);
}

}  // namespace
}  // namespace cellmirror::app
