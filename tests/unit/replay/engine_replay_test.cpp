// Recorded inputs give the same states again, and what differs is found.
#include "app/replay/engine_replay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "tests/unit/engine/commands.hpp"

namespace cellmirror::app {
namespace {

using engine::Engine;
using engine::EngineCapacity;
using engine::InputRecord;

constexpr Nanoseconds kPeriod{2'000'000};
constexpr std::size_t kSimulated = 0;
constexpr std::size_t kMirrored = 1;
constexpr std::size_t kSlave = 2;

// A hand that goes to and fro in front of a wall.
class Hand final : public HapticDevicePort {
 public:
  HapticRead read(HapticSample& out) CELL_RT override {
    out = HapticSample();
    out.sequence = ++sequence_;
    out.time = *now;
    out.valid = true;
    out.writer = 1;
    out.p_DH.x() = 0.02 * std::sin(0.01 * static_cast<double>(sequence_));
    out.buttons = buttons;
    return HapticRead::fresh;
  }
  void write(const HapticOutput& /*output*/) CELL_RT override {}
  const Timestamp* now = nullptr;
  std::uint32_t buttons = 0;

 private:
  std::uint64_t sequence_ = 0;
};

kinematics::Chain slides() {
  std::vector<kinematics::Variable> variables;
  for (const char* name : {"X", "Y", "Z"}) variables.push_back({name, JointKind::prismatic, -1.0, 1.0});
  Pose turn = Pose::Identity();
  turn.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x to y, y to z, z to x
  std::vector<kinematics::ChainJoint> joints(3);
  for (std::uint8_t i = 0; i < 3; ++i) joints[i] = {.X_PJ = turn, .kind = JointKind::prismatic, .variable = i};
  return *kinematics::Chain::make(variables, joints, Pose::Identity());
}

void append(std::vector<std::byte>& out, InputRecord kind, ByteSpan content) {
  const auto length = static_cast<std::uint32_t>(content.size());
  const auto length_bytes = std::as_bytes(std::span(&length, 1));
  out.push_back(static_cast<std::byte>(kind));
  out.insert(out.end(), length_bytes.begin(), length_bytes.end());
  out.insert(out.end(), content.begin(), content.end());
}

class EngineReplayTest : public testing::Test {
 protected:
  EngineReplayTest() {
    for (std::size_t slot = 0; slot < 3; ++slot) send_robot(*engine_, slot, engine::robot_of(3, -2, 2));
    engine_->send(engine::SetMode{.slot = kMirrored, .mode = engine::RobotMode::mirrored});
    engine_->send(engine::SetChain{.slot = kSimulated, .chain = engine_->lend(chain_)});
    engine::Coupling coupling;
    coupling.master = kMirrored;
    coupling.slave = kSlave;
    coupling.count = 1;
    coupling.max_velocity.fill(1);
    send_coupling(*engine_, coupling);
    tick(3);
  }

  void tick(int times) {
    for (int i = 0; i < times; ++i) {
      now_ = now_ + kPeriod;
      CycleContext context;
      context.now = now_;
      context.scheduled = now_ - Nanoseconds(1234);
      context.cycle = cycle_++;
      context.period = kPeriod;
      context.missed = cycle_ % 50 == 0 ? 1 : 0;
      const JointSample sample = engine::sample_of_curve(now_ - Nanoseconds(100'000), cycle_);
      if (cycle_ % 3 != 0) engine_->inlet(kMirrored).push(sample);
      engine_->run(context);
    }
  }

  void move(motion::MoveKind kind, double to) {
    motion::Move one;
    one.kind = kind;
    one.start = motion::Start::queue;
    one.id = ++move_id_;
    one.max_velocity.fill(3);
    one.velocity.fill(1);
    one.acceleration.fill(4);
    one.target.fill(to);
    one.X_BG.translation() = Eigen::Vector3d(to, 0.1, 0.2);
    one.linear_velocity = one.rotational_velocity = 0.5;
    one.linear_acceleration = one.rotational_acceleration = 2;
    one.fly_parameter = 0.05;
    send_move(*engine_, kSimulated, one);
  }

  void open_hand() {
    hand_->now = &now_;
    haptics::Instrument instrument{.slot = kSimulated, .joint_count = 3, .chain = slides(), .settings = {}};
    for (std::uint8_t i = 0; i < 3; ++i) instrument.variable_joint[i] = i;
    instrument.lower.fill(-1);
    instrument.upper.fill(1);
    instrument.settings.clutch_button = 0;
    engine_->send(engine::SetMode{.slot = kSimulated, .mode = engine::RobotMode::mirrored});
    engine_->send(engine::OpenHaptic{
        .channel = 1,
        .instrument = engine_->lend(std::make_shared<const haptics::Instrument>(std::move(instrument))),
        .device = engine_->lend<HapticDevicePort>(hand_)});
  }
  void give_model() {
    haptics::ContactModel& model = engine_->contact_inlet(1).writable();
    model = haptics::ContactModel();
    model.sequence = ++models_;
    model.posture_time = now_;
    model.slot = kSimulated;
    model.reach = 1;
    model.count = 1;
    model.constraints[0].a = model.constraints[0].normal = -Eigen::Vector3d::UnitX();
    model.constraints[0].gap = 0.01;
    engine_->contact_inlet(1).publish();
  }

  void give_tissue() {
    haptics::TissueForce tissue;
    tissue.sequence = ++tissues_;
    tissue.posture_time = now_;
    tissue.slot = kSimulated;
    tissue.x_ref = ticks_.newest().haptics[1].x_proxy;
    tissue.force_W = Eigen::Vector3d(0, 0.5, 0);
    tissue.stiffness = Eigen::Matrix3d::Identity() * 50;
    tissue.contacts = 1;
    engine_->tissue_inlet(1).writable() = tissue;
    engine_->tissue_inlet(1).publish();
  }
  // A hand meets a wall and tissue, uses the clutch, is faulted and reset.
  void hand_at_work(int i) {
    if (i < 600 || i > 900) give_model();
    if (i > 300 && i % 3 == 0) give_tissue();
    hand_->buttons = i > 400 && i < 480 ? 1 : 0;
    if (i == 950) engine_->send(engine::ResetHaptic{.channel = 1});
    tick(1);
  }

  std::vector<std::byte> message() {
    std::vector<std::byte> out{std::byte{engine::kInputsVersion}};
    engine_->inputs().drain(out);
    return out;
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<Engine> engine_ = std::make_unique<Engine>(watchdog_, EngineCapacity{.robots = 4});
  engine::TickReader& ticks_ = engine_->subscribe("test");
  std::shared_ptr<const kinematics::Chain> chain_ = std::make_shared<const kinematics::Chain>(slides());
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
  std::uint32_t move_id_ = 0;
  std::uint64_t models_ = 0;
  std::uint64_t tissues_ = 0;
  std::shared_ptr<Hand> hand_ = std::make_shared<Hand>();
  EngineReplay sut_;
};

TEST_F(EngineReplayTest, EachTickIsEqualToTheBit) {
  engine_->inputs().request_start();
  move(motion::MoveKind::joints, 0.5);
  move(motion::MoveKind::linear, -0.4);
  move(motion::MoveKind::linear, 0.4);
  tick(1000);
  sut_.take(message());
  EXPECT_FALSE(sut_.difference()) << sut_.difference()->what << sut_.difference()->computed;
  EXPECT_EQ(sut_.counts().ticks, 1000U);
  EXPECT_EQ(sut_.counts().first_problem, "");
}

// They would say where the memory of the gateway is.
TEST_F(EngineReplayTest, NoAddressOfTheProcessIsInARecording) {
  move(motion::MoveKind::linear, 0.4);
  tick(10);
  engine_->inputs().request_start();
  engine_->send(engine::SetChain{.slot = kSlave, .chain = engine_->lend(chain_)});
  open_hand();
  tick(10);
  const std::vector<std::byte> bytes = message();
  const kinematics::Chain* const chain = chain_.get();
  const auto address = std::as_bytes(std::span(&chain, 1));
  EXPECT_TRUE(std::ranges::search(bytes, address).empty());
  sut_.take(bytes);
  EXPECT_EQ(sut_.counts().ticks, 10U) << sut_.counts().first_problem;
}

// At any moment of a motion: on a path, within a fly point, while it brakes, with moves that wait.
TEST_F(EngineReplayTest, ARecordingMayBeginWhileRobotsMove) {
  for (int i = 0; i < 6; ++i)
    move(i % 3 == 0 ? motion::MoveKind::joints : motion::MoveKind::linear, i % 2 == 0 ? 0.5 : -0.5);
  for (int begin = 0; begin < 40; ++begin) {
    tick(37);
    if (begin == 30) {
      engine_->send(engine::StopMotion{.slot = kSimulated});
      tick(5);  // it brakes
    }
    engine_->inputs().request_start();
    tick(60);
    EngineReplay replay;
    replay.take(message());
    engine_->inputs().end();
    ASSERT_FALSE(replay.difference()) << begin << ' ' << replay.difference()->what << ' '
                                      << replay.difference()->recorded << ' ' << replay.difference()->computed;
    ASSERT_EQ(replay.counts().ticks, 60U) << begin << replay.counts().first_problem;
  }
}

TEST_F(EngineReplayTest, AHapticDeviceThatWasOpenedWhileRecordingIsComparedToo) {
  engine_->inputs().request_start();
  open_hand();
  for (int i = 0; i < 500; ++i) {
    give_model();
    tick(1);
  }
  ASSERT_EQ(ticks_.newest().haptics[1].phase, HapticPhase::active);
  sut_.take(message());
  EXPECT_FALSE(sut_.difference()) << sut_.difference()->what << sut_.difference()->computed;
  EXPECT_EQ(sut_.counts().ticks, 500U) << sut_.counts().first_problem;
  EXPECT_TRUE(sut_.channels_taken_over().empty());
}

// In any phase, in contact and not.
TEST_F(EngineReplayTest, OneThatWasOpenBeforeIsComparedToo) {
  open_hand();
  tick(1);
  std::set<HapticPhase> phases;
  int felt = 0;
  for (int i = 0; i < 1200; i += 40) {
    const HapticState& before = ticks_.newest().haptics[1];
    phases.insert(before.phase);
    felt += before.force_W.isZero(0) ? 0 : 1;
    engine_->inputs().request_start();
    for (int k = 0; k < 40; ++k) hand_at_work(i + k);
    EngineReplay replay;
    replay.take(message());
    engine_->inputs().end();
    ASSERT_FALSE(replay.difference()) << i << ' ' << replay.difference()->what << "\n"
                                      << replay.difference()->recorded << "\n"
                                      << replay.difference()->computed;
    ASSERT_EQ(replay.counts().ticks, 40U) << i << replay.counts().first_problem;
    ASSERT_TRUE(replay.channels_taken_over().empty());
  }
  phases.insert(HapticPhase::closed);
  EXPECT_EQ(phases.size(), 6U) << "not all phases were met";
  EXPECT_GT(felt, 3);
}

TEST_F(EngineReplayTest, ItMayBeOpenedAgainWithAnotherInstrument) {
  open_hand();
  for (int i = 0; i < 100; ++i) hand_at_work(i);
  engine_->inputs().request_start();
  for (int i = 0; i < 100; ++i) {
    if (i == 50) open_hand();
    hand_at_work(i);
  }
  sut_.take(message());
  EXPECT_FALSE(sut_.difference()) << sut_.difference()->what << sut_.difference()->computed;
  EXPECT_EQ(sut_.counts().ticks, 100U) << sut_.counts().first_problem;
}

TEST_F(EngineReplayTest, APlantedBitOfItsModelsIsFound) {
  open_hand();
  for (int i = 0; i < 100; ++i) hand_at_work(i);
  engine_->inputs().request_start();
  for (int i = 100; i < 300; ++i) hand_at_work(i);
  std::vector<std::byte> bytes = message();
  const double gap = 0.01;  // of the wall
  const auto wanted = std::as_bytes(std::span(&gap, 1));
  for (std::span<std::byte> rest = bytes; !rest.empty();) {
    const auto found = std::ranges::search(rest, wanted);
    if (found.empty()) break;
    found.front() ^= std::byte{1};
    rest = std::span(found.end(), rest.end());
  }
  sut_.take(bytes);
  ASSERT_TRUE(sut_.difference());
}

// Their start states end behind the couplings.
TEST_F(EngineReplayTest, OfAnOlderRecordingTheRobotIsComparedAlone) {
  const auto size_of_start = [](ByteSpan bytes) {
    std::size_t size = 0;
    EXPECT_TRUE(for_each_record(bytes, [&](InputRecord kind, ByteSpan content) {
      size = kind == InputRecord::start ? content.size() : size;
      return true;
    }));
    return size;
  };
  open_hand();
  for (int i = 0; i < 100; ++i) hand_at_work(i);
  engine_->inputs().request_start();
  for (int i = 100; i < 400; ++i) hand_at_work(i);
  const std::vector<std::byte> bytes = message();
  engine_->inputs().end();
  engine_->send(engine::CloseHaptic{.channel = 1});
  tick(1);
  engine_->inputs().request_start();
  tick(1);
  const std::size_t without = size_of_start(message());
  ASSERT_LT(without, size_of_start(bytes));
  std::vector<std::byte> older{std::byte{engine::kInputsVersion}};
  ASSERT_TRUE(for_each_record(bytes, [&](InputRecord kind, ByteSpan content) {
    append(older, kind, kind == InputRecord::start ? content.first(without) : content);
    return true;
  }));
  sut_.take(older);
  EXPECT_FALSE(sut_.difference()) << sut_.difference()->what << sut_.difference()->computed;
  EXPECT_EQ(sut_.counts().ticks, 300U) << sut_.counts().first_problem;
  EXPECT_EQ(sut_.channels_taken_over(), std::vector<std::uint8_t>{1});
}

// The last bit of one position of a sample.
TEST_F(EngineReplayTest, APlantedBitIsFoundWithTickRobotAndJoint) {
  engine_->inputs().request_start();
  tick(20);
  std::vector<std::byte> bytes{std::byte{engine::kInputsVersion}};
  append(bytes, InputRecord::robots, names_record({{kMirrored, {"ARM", {"J1", "J2", "J3"}}}}));
  engine_->inputs().drain(bytes);
  // In the last tick that has a sample, the second joint of that sample. Head of a tick: 8 numbers of 8 bytes.
  std::size_t at = 0;
  std::uint64_t tick = 0;
  ASSERT_TRUE(for_each_record(bytes, [&](InputRecord kind, ByteSpan content) {
    if (kind != InputRecord::tick || content[64] != std::byte{1}) return true;
    std::memcpy(&tick, content.data(), 8);
    constexpr std::size_t kBeforePositions = 64 + 1 + 1 + 2 + 3 * 8 + 3 * 4;
    at = static_cast<std::size_t>(content.data() - bytes.data()) + kBeforePositions + 8;
    return true;
  }));
  ASSERT_NE(at, 0U);
  bytes[at] ^= std::byte{1};
  sut_.take(bytes);
  ASSERT_TRUE(sut_.difference());
  EXPECT_EQ(sut_.difference()->tick, tick);
  EXPECT_EQ(sut_.difference()->robot, "ARM");
  EXPECT_EQ(sut_.difference()->joint, "J2");
  EXPECT_EQ(sut_.difference()->what, "position");
  EXPECT_NE(sut_.difference()->recorded, sut_.difference()->computed);
}

TEST_F(EngineReplayTest, AfterAGapItGoesOnAtTheNextStartState) {
  engine_->inputs().request_start();
  tick(20);
  sut_.take(message());
  tick(20);
  static_cast<void>(message());  // lost
  tick(20);
  engine_->inputs().request_start();
  tick(20);
  sut_.take(message());
  EXPECT_FALSE(sut_.difference());
  EXPECT_EQ(sut_.counts().ticks, 40U);
  EXPECT_EQ(sut_.counts().skipped, 20U);
  EXPECT_EQ(sut_.counts().gaps, 1U);
  EXPECT_EQ(sut_.counts().starts, 2U);
}

// As it is where the tick itself found no room for a record.
TEST_F(EngineReplayTest, AStartStateRightAfterAGapIsTaken) {
  engine_->inputs().request_start();
  tick(20);
  sut_.take(message());
  tick(20);
  static_cast<void>(message());  // lost
  engine_->inputs().request_start();
  tick(20);
  sut_.take(message());
  EXPECT_FALSE(sut_.difference());
  EXPECT_EQ(sut_.counts().ticks, 40U);
  EXPECT_EQ(sut_.counts().skipped, 0U);
  EXPECT_EQ(sut_.counts().gaps, 1U);
  EXPECT_EQ(sut_.counts().starts, 2U);
}

TEST_F(EngineReplayTest, AStartStateThatWasChangedIsRefusedOrDiffersAndNeverCrashes) {
  move(motion::MoveKind::linear, 0.4);
  move(motion::MoveKind::linear, -0.4);
  open_hand();
  for (int i = 0; i < 100; ++i) hand_at_work(i);
  engine_->inputs().request_start();
  for (int i = 100; i < 103; ++i) hand_at_work(i);
  const std::vector<std::byte> whole = message();
  for (std::size_t at = 1; at < whole.size(); at += 41) {
    std::vector<std::byte> bytes = whole;
    bytes[at] ^= std::byte{0x81};
    EngineReplay replay;
    replay.take(bytes);
  }
}

}  // namespace
}  // namespace cellmirror::app
