// Haptic devices inside the tick.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

constexpr std::uint8_t kHapticSlot = 5;
constexpr std::uint8_t kChannel = 2;

// Three slides along x, y, z: the tip stands where the joints say.
kinematics::Chain slides() {
  std::vector<kinematics::Variable> variables;
  for (const char* name : {"X", "Y", "Z"}) variables.push_back({name, JointKind::prismatic, -1.0, 1.0});
  // The z axis of each joint's frame points along world x, y, z in turn: a turn of all axes into each other.
  Pose turn = Pose::Identity();
  turn.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x to y, y to z, z to x
  kinematics::ChainJoint joint;
  joint.kind = JointKind::prismatic;
  std::vector<kinematics::ChainJoint> joints(3, joint);
  for (std::uint8_t i = 0; i < 3; ++i) {
    joints[i].variable = i;
    joints[i].X_PJ = turn;
  }
  return *kinematics::Chain::make(variables, joints, Pose::Identity());
}

// Says what the test tells it to say, each tick anew, and keeps what it hears.
class TestDevice final : public HapticDevicePort {
 public:
  HapticRead read(HapticSample& out) CELL_RT override {
    if (silent) return HapticRead::unchanged;
    ++sample.sequence;
    sample.time = *now;
    out = sample;
    return HapticRead::fresh;
  }
  void write(const HapticOutput& output) CELL_RT override {
    ++written;
    last = output;
  }

  HapticSample sample;
  HapticOutput last;
  std::uint64_t written = 0;
  bool silent = false;
  const Timestamp* now = nullptr;
};

class EngineHapticsTest : public testing::Test {
 protected:
  EngineHapticsTest() {
    device_.now = &now_;
    device_.sample.valid = true;
    device_.sample.writer = 4711;
    apply(haptics::HapticProfile::strict, instrument_.settings);
    instrument_.settings.engage_time = Nanoseconds(10'000'000);
    instrument_.settings.max_speed = 100;
    instrument_.lower.fill(-1.0);
    instrument_.upper.fill(1.0);
    for (std::uint8_t i = 0; i < 3; ++i) instrument_.variable_joint[i] = i;
    send_robot(*sut_, kHapticSlot, robot_of(3, -1.0, 1.0));
    sut_->send(SetMode{.slot = kHapticSlot, .mode = RobotMode::mirrored});
    tick();
  }

  void tick(int times = 1) { run_cycles(*sut_, now_, cycle_, times); }

  // The newest surroundings: a wall whose surface is at x = `wall`, free below it.
  void give_model(double wall) {
    haptics::ContactModel& model = sut_->contact_inlet(kChannel).writable();
    model = haptics::ContactModel();
    model.sequence = ++model_sequence_;
    model.posture_time = now_;
    model.slot = kHapticSlot;
    model.reach = 1.0;
    model.x_ref = {0, 0, 0};
    model.count = 1;
    model.constraints[0].a = -Eigen::Vector3d::UnitX();
    model.constraints[0].normal = -Eigen::Vector3d::UnitX();
    model.constraints[0].gap = wall;
    sut_->contact_inlet(kChannel).publish();
  }

  // The newest force of soft tissue on an instrument that touches it.
  void give_tissue(const Eigen::Vector3d& force, std::uint8_t slot = kHapticSlot) {
    haptics::TissueForce& tissue = sut_->tissue_inlet(kChannel).writable();
    tissue = haptics::TissueForce();
    tissue.sequence = ++tissue_sequence_;
    tissue.posture_time = now_;
    tissue.slot = slot;
    tissue.force_W = force;
    tissue.contacts = 3;
    sut_->tissue_inlet(kChannel).publish();
  }

  // Ticks with a fresh model each, until the channel is active.
  void run(int ticks, double wall = 0.5) {
    for (int i = 0; i < ticks; ++i) {
      give_model(wall);
      tick();
    }
  }

  OpenHaptic open(std::uint8_t channel, std::shared_ptr<TestDevice> device) {
    return {.channel = channel,
            .instrument = sut_->lend(std::make_shared<const haptics::Instrument>(instrument_)),
            .device = sut_->lend<HapticDevicePort>(std::move(device))};
  }

  void engage() {
    sut_->send(open(kChannel, shared_device_));
    run(50);
    ASSERT_EQ(haptic().phase, HapticPhase::active);
  }

  const HapticState& haptic() { return ticks_.newest().haptics[kChannel]; }
  const RobotTickState& robot() { return ticks_.newest().robots[kHapticSlot]; }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<Engine> sut_ = std::make_unique<Engine>(watchdog_);
  TickReader& ticks_ = sut_->subscribe("test");
  TickReader& second_ = sut_->subscribe("second");
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
  std::uint64_t model_sequence_ = 0;
  std::uint64_t tissue_sequence_ = 0;
  haptics::Instrument instrument_{kHapticSlot, 3, slides(), {}, Pose::Identity(), {}, {}, {}};
  std::shared_ptr<TestDevice> shared_device_ = std::make_shared<TestDevice>();
  TestDevice& device_ = *shared_device_;
};

TEST_F(EngineHapticsTest, InstrumentFollowsTheHandAsAMirroredRobot) {
  engage();
  device_.sample.p_DH = {0.01, -0.02, 0.03};
  run(200);
  EXPECT_EQ(robot().mode, RobotMode::mirrored);
  EXPECT_EQ(robot().state, DataState::fresh);
  EXPECT_NEAR((haptic().x_device - Eigen::Vector3d(0.01, -0.02, 0.03)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((haptic().x_proxy - haptic().x_device).norm(), 0.0, 1e-6);
  EXPECT_EQ(haptic().slot, kHapticSlot);
  EXPECT_EQ(haptic().device_writer, 4711U);
  EXPECT_EQ(second_.newest().haptics[kChannel].samples, haptic().samples);
}

TEST_F(EngineHapticsTest, EveryTickIsAnsweredInTheSameTick) {
  engage();
  const std::uint64_t before = device_.written;
  run(10);
  EXPECT_EQ(device_.written, before + 10);
  EXPECT_EQ(device_.last.answers, device_.sample.sequence);
  EXPECT_EQ(device_.last.time, now_);
}

TEST_F(EngineHapticsTest, WallPushesBack) {
  engage();
  for (int i = 0; i < 100; ++i) {
    device_.sample.p_DH.x() = 0.503 * (i + 1) / 100.0;
    run(1);
  }
  run(200);
  EXPECT_LT(haptic().x_proxy.x(), 0.5 + 1e-6);
  EXPECT_NEAR(device_.last.force_D.x(), -0.003 * instrument_.settings.stiffness, 0.05);
  EXPECT_EQ(haptic().contacts, 1);
}

TEST_F(EngineHapticsTest, ClosingWritesZeroAndClearsTheStateInEveryBuffer) {
  engage();
  sut_->send(CloseHaptic{kChannel});
  tick();
  EXPECT_EQ(device_.last.force_D, Eigen::Vector3d::Zero());
  const std::uint64_t written = device_.written;
  for (int i = 0; i < 5; ++i) {
    tick();
    EXPECT_EQ(haptic().phase, HapticPhase::closed);
    EXPECT_EQ(haptic().samples, 0U);
  }
  EXPECT_EQ(device_.written, written);
}

TEST_F(EngineHapticsTest, FaultTakesTheForceWithinTwoTicksAndStaysUntilReset) {
  engage();
  device_.sample.p_DH.y() = std::numeric_limits<double>::quiet_NaN();
  run(2);
  EXPECT_EQ(haptic().phase, HapticPhase::faulted);
  EXPECT_EQ(haptic().fault, HapticFault::not_finite);
  EXPECT_EQ(device_.last.force_D, Eigen::Vector3d::Zero());
  const std::uint64_t refused = ticks_.newest().commands_refused;
  sut_->send(ResetHaptic{kChannel});
  run(1);
  EXPECT_EQ(ticks_.newest().commands_refused, refused + 1);  // the cause is still there
  device_.sample.p_DH.y() = 0;
  run(50);
  EXPECT_EQ(haptic().phase, HapticPhase::faulted);
  sut_->send(ResetHaptic{kChannel});
  run(60);
  EXPECT_EQ(haptic().phase, HapticPhase::active);
}

TEST_F(EngineHapticsTest, DeviceThatIsKnownToHaveEndedIsAFaultThatCannotBeResetBeforeItIsBack) {
  instrument_.settings.stale_after = Nanoseconds(1'000'000'000);
  engage();
  device_.silent = true;
  sut_->send(SetDeviceGone{.channel = kChannel, .gone = true});
  run(3);
  EXPECT_EQ(haptic().fault, HapticFault::vanished);
  run(50);
  sut_->send(ResetHaptic{kChannel});
  run(2);
  EXPECT_EQ(haptic().phase, HapticPhase::faulted);
  device_.silent = false;
  sut_->send(SetDeviceGone{.channel = kChannel, .gone = false});
  run(50);
  sut_->send(ResetHaptic{kChannel});
  run(60);
  EXPECT_EQ(haptic().phase, HapticPhase::active);
}

TEST_F(EngineHapticsTest, ResetInTheTickInWhichTheDeviceIsKnownToHaveEndedIsRefused) {
  engage();
  device_.sample.p_DH.y() = std::numeric_limits<double>::quiet_NaN();
  run(2);
  device_.sample.p_DH.y() = 0;
  run(50);
  ASSERT_EQ(haptic().fault, HapticFault::not_finite);
  const std::uint64_t refused = ticks_.newest().commands_refused;
  sut_->send(SetDeviceGone{.channel = kChannel, .gone = true});
  sut_->send(ResetHaptic{kChannel});
  run(1);
  EXPECT_EQ(ticks_.newest().commands_refused, refused + 1);
  EXPECT_EQ(haptic().phase, HapticPhase::faulted);
}

TEST_F(EngineHapticsTest, FaultOutlivesAnotherInstrumentOfTheSameDevice) {
  engage();
  sut_->send(SetDeviceGone{.channel = kChannel, .gone = true});
  sut_->send(open(kChannel, shared_device_));  // in the same instant
  run(1);
  ASSERT_EQ(haptic().fault, HapticFault::vanished);
  sut_->send(open(kChannel, shared_device_));
  run(50);
  EXPECT_EQ(haptic().phase, HapticPhase::faulted);
  sut_->send(CloseHaptic{kChannel});
  sut_->send(open(kChannel, shared_device_));
  run(50);
  EXPECT_EQ(haptic().phase, HapticPhase::active) << "offline and online begins anew";
}

TEST_F(EngineHapticsTest, CommandsThatNameNothingAreRefused) {
  sut_->send(OpenHaptic{.channel = kChannel});
  sut_->send(open(kMaxHapticDevices, shared_device_));
  sut_->send(OpenHaptic{.channel = kChannel, .device = sut_->lend<HapticDevicePort>(shared_device_)});
  sut_->send(CloseHaptic{kMaxHapticDevices});
  sut_->send(ResetHaptic{kMaxHapticDevices});
  sut_->send(SetDeviceGone{.channel = kMaxHapticDevices, .gone = true});
  sut_->send(ResetHaptic{kChannel});
  const std::uint64_t before = ticks_.newest().commands_refused;
  tick();
  EXPECT_EQ(ticks_.newest().commands_refused, before + 7);
  EXPECT_EQ(haptic().phase, HapticPhase::closed);
}

TEST_F(EngineHapticsTest, InstrumentOfASlotBeyondTheRobotsIsRefused) {
  sut_ =
      std::make_unique<Engine>(watchdog_, EngineCapacity{.robots = kHapticSlot, .haptic_devices = kMaxHapticDevices});
  TickReader& reader = sut_->subscribe("beyond");
  sut_->send(open(kChannel, shared_device_));  // its slot is the first that is not there
  tick(3);
  EXPECT_EQ(reader.newest().commands_refused, 1U);
  EXPECT_EQ(reader.newest().haptics[kChannel].phase, HapticPhase::closed);
  EXPECT_EQ(device_.written, 0U);
}

TEST_F(EngineHapticsTest, ModelOfTheTickInWhichItWasOpenedIsUsed) {
  sut_->send(open(kChannel, shared_device_));
  tick();
  give_model(0.5);  // of that tick
  const Timestamp opened = now_;
  tick();
  EXPECT_EQ(haptic().model_time, opened);
}

TEST_F(EngineHapticsTest, ModelOfAnInstrumentThatHadTheChannelBeforeIsNotUsed) {
  give_model(0.5);
  tick();
  sut_->send(open(kChannel, shared_device_));
  tick(2);
  EXPECT_FALSE(haptic().model_time.known());
  run(2);
  EXPECT_TRUE(haptic().model_time.known());
}

TEST_F(EngineHapticsTest, ForceOfTissueReachesTheDeviceAndTheState) {
  engage();
  for (int i = 0; i < 150; ++i) {
    give_tissue({0, 0.25, 0.5});
    run(1);
  }
  EXPECT_NEAR((device_.last.force_D - Eigen::Vector3d(0, 0.25, 0.5)).norm(), 0, 1e-9);
  EXPECT_NEAR((haptic().force_E - haptic().tissue_force_W).norm(), 0, 1e-9) << "the tool's axes are the world's";
  EXPECT_EQ(haptic().tissue_contacts, 3U);
  EXPECT_EQ(haptic().tissue_time, now_ - kPeriod);
  EXPECT_EQ(haptic().tissue_late, 0U);
  give_tissue({0, 0, std::numeric_limits<double>::infinity()});
  run(1);
  EXPECT_EQ(haptic().tissue_refused, 1U);
  EXPECT_NEAR(device_.last.force_D.z(), 0.5, 1e-9);
}

TEST_F(EngineHapticsTest, ForceOfTissueOnWhatHadTheChannelBeforeIsNotUsed) {
  give_tissue({0, 0, 1});
  tick();
  sut_->send(open(kChannel, shared_device_));
  run(200);
  EXPECT_FALSE(haptic().tissue_time.known());
  for (int i = 0; i < 150; ++i) {
    give_tissue({0, 0, 1}, kHapticSlot + 1);
    run(1);
  }
  EXPECT_FALSE(haptic().tissue_time.known());
  EXPECT_EQ(device_.last.force_D, Eigen::Vector3d::Zero());
}

TEST_F(EngineHapticsTest, InstrumentAndDeviceAreGivenBackWhenTheChannelHasNoUseForThem) {
  engage();
  ASSERT_EQ(sut_->lent(), 2U);
  sut_->send(open(kChannel, shared_device_));  // another instrument
  run(1);
  sut_->free_returned();
  EXPECT_EQ(sut_->lent(), 2U);
  sut_->send(open(kChannel, std::make_shared<TestDevice>(device_)));  // another device
  run(1);
  sut_->free_returned();
  EXPECT_EQ(sut_->lent(), 2U);
  EXPECT_EQ(shared_device_.use_count(), 1) << "the first device is free";
  sut_->send(CloseHaptic{kChannel});
  run(1);
  sut_->free_returned();
  EXPECT_EQ(sut_->lent(), 0U);
}

TEST_F(EngineHapticsTest, WhatTheTickStillHasIsFreedWithTheEngine) {
  engage();
  const std::weak_ptr<TestDevice> watched = shared_device_;
  sut_->send(open(kChannel, shared_device_));  // waits in the queue
  shared_device_.reset();
  EXPECT_FALSE(watched.expired());
  sut_.reset();
  EXPECT_TRUE(watched.expired());
}

TEST_F(EngineHapticsTest, FourOpenChannelsTakeNoHeapMemory) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  std::array<std::shared_ptr<TestDevice>, kMaxHapticDevices> devices;
  for (std::uint8_t i = 0; i < kMaxHapticDevices; ++i) {
    devices[i] = std::make_shared<TestDevice>(device_);
    sut_->send(open(i, devices[i]));
  }
  const AllocationGuard guard;
  run(300, 0.0);
  for (const auto& device : devices) device->sample.p_DH.x() = 0.002;
  run(300, 0.0);
  for (int i = 0; i < 50; ++i) {
    give_tissue({-0.1, 0, 0.1});
    run(1, 0.0);
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
  EXPECT_LT(devices[kChannel]->last.force_D.x(), -1.0);
}

}  // namespace
}  // namespace cellmirror::engine
