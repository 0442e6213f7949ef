// The CiA 402 device in virtual time on a bus in memory.
#include "sim_devices/robot/cia402_robots.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "drivers/can/canopen/nmt.hpp"
#include "drivers/can/channel/virtual_bus.hpp"

namespace cellmirror::sim {
namespace {

using ::testing::ElementsAre;

constexpr Timestamp kStart{1'000'000'000};
constexpr Nanoseconds kMs{1'000'000};

class Cia402RobotsTest : public ::testing::Test {
 public:
  Cia402RobotsConfig config() {
    Cia402RobotsConfig config;
    config.endpoint = "virtual";
    config.nodes = {{1, 2}};
    config.increments_per_unit = {1000.0};
    config.heartbeat_ms = 0;
    config.self_starting = true;
    return config;
  }

  void make(const Cia402RobotsConfig& config, const char* motion = "ramp:velocity=1") {
    sut = std::make_unique<Cia402Robots>(
        config, std::shared_ptr<const MotionSource>(std::move(*make_motion(motion, 2))), bus.connect());
    sut->start(kStart);
    now = kStart;
    sut->work(now);
  }

  // Lets virtual time go on from event to event.
  void run_until_ms(std::int64_t ms) {
    const Timestamp end = kStart + ms * kMs;
    while (sut->next() <= end) {
      now = std::max(sut->next(), now);
      sut->work(now);
    }
    now = end;
    sut->work(now);
  }

  // A master's frame, heard and answered now.
  void tell(const CanFrame& frame) {
    ASSERT_TRUE(master->send(frame));
    sut->wait_until(SystemClock().now() + Nanoseconds(1'000'000'000));  // returns as soon as the frame is there
    sut->work(now);
  }

  std::vector<CanFrame> heard() {
    std::vector<CanFrame> frames;
    ReceivedCanFrame received;
    while (master->receive(received, Nanoseconds(0)) == CanReceive::frame) frames.push_back(received.frame);
    return frames;
  }

  std::vector<std::int32_t> positions_of(std::uint32_t node) {
    std::vector<std::int32_t> positions;
    for (const CanFrame& frame : heard()) {
      if (frame.id != 0x180 + node || frame.length != 6) continue;
      std::uint32_t raw = 0;
      for (std::size_t i = 0; i < 4; ++i) raw |= std::uint32_t{frame.data[2 + i]} << (8 * i);
      positions.push_back(static_cast<std::int32_t>(raw));
    }
    return positions;
  }

  can::VirtualCanBus bus{100'000};
  std::unique_ptr<CanChannel> master = bus.connect();
  std::unique_ptr<Cia402Robots> sut;
  Timestamp now;
};

TEST_F(Cia402RobotsTest, SamplesArePeriodicAndOnTheMotionToTheIncrement) {
  Cia402RobotsConfig c = config();
  c.sample_period_ms = 10;
  make(c);
  run_until_ms(1000);
  const std::vector<std::int32_t> positions = positions_of(2);
  ASSERT_GE(positions.size(), 99U);
  ASSERT_LE(positions.size(), 101U);
  for (std::size_t i = 2; i < positions.size(); ++i) EXPECT_EQ(positions[i] - positions[i - 1], 10);
}

TEST_F(Cia402RobotsTest, EachJointHasItsScaleAndSense) {
  Cia402RobotsConfig c = config();
  c.increments_per_unit = {1000.0, -2000.0};
  make(c, "hold:position=0.5");
  run_until_ms(50);
  std::vector<std::int32_t> last;
  for (const CanFrame& frame : heard()) {
    if (frame.id == 0x182)
      last.push_back(static_cast<std::int32_t>(frame.data[2] | (frame.data[3] << 8) | (frame.data[4] << 16) |
                                               (frame.data[5] << 24)));
  }
  ASSERT_FALSE(last.empty());
  EXPECT_EQ(last.back(), -1000);
}

TEST_F(Cia402RobotsTest, WaitsForNmtStartUnlessSelfStarting) {
  Cia402RobotsConfig c = config();
  c.self_starting = false;
  make(c);
  run_until_ms(100);
  EXPECT_EQ(heard().size(), 2U);  // the boot-up messages
  tell(can::encode_nmt({can::NmtCommand::start, 2}));
  run_until_ms(200);
  for (const CanFrame& frame : heard()) EXPECT_EQ(frame.id, 0x182U);
}

TEST_F(Cia402RobotsTest, OneSampleOfEachDriveForASync) {
  Cia402RobotsConfig c = config();
  c.on_sync = true;
  make(c);
  (void)heard();
  run_until_ms(500);
  EXPECT_TRUE(heard().empty());
  tell(can::encode_sync());
  const std::vector<CanFrame> frames = heard();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(sut->status(now).sent[static_cast<std::size_t>(MessageKind::sample)], 2U);
}

TEST_F(Cia402RobotsTest, ProducesSyncAndAnswersItItself) {
  Cia402RobotsConfig c = config();
  c.on_sync = true;
  c.sync_period = 20 * kMs;
  make(c);
  (void)heard();
  run_until_ms(200);
  std::size_t syncs = 0;
  std::size_t samples = 0;
  for (const CanFrame& frame : heard()) ++(frame.id == 0x80 ? syncs : samples);
  EXPECT_EQ(syncs, 10U);
  EXPECT_EQ(samples, 2 * syncs);
}

TEST_F(Cia402RobotsTest, DeathSilencesOneDriveAtOnceAndItsReturnIsABootUp) {
  make(config());
  ASSERT_TRUE(sut->execute(AddFault{*parse_fault("death:joint=2@0.1..0.3")}, kStart));
  run_until_ms(99);
  (void)heard();
  run_until_ms(299);
  for (const CanFrame& frame : heard()) EXPECT_EQ(frame.id, 0x181U);
  run_until_ms(300);
  const std::vector<CanFrame> frames = heard();
  const auto boot_up = std::find_if(frames.begin(), frames.end(), [](const auto& frame) { return frame.id == 0x702; });
  ASSERT_NE(boot_up, frames.end());
  EXPECT_EQ(boot_up->data[0], 0);
}

TEST_F(Cia402RobotsTest, HeldMotionGoesOnWhereItStood) {
  make(config());
  run_until_ms(100);
  ASSERT_TRUE(sut->execute(SetHeld{true}, now));
  run_until_ms(500);
  ASSERT_TRUE(sut->execute(SetHeld{false}, now));
  (void)heard();
  run_until_ms(600);
  const std::vector<std::int32_t> positions = positions_of(1);
  ASSERT_FALSE(positions.empty());
  EXPECT_LE(positions.back(), 200);
  EXPECT_GE(positions.back(), 180);
}

TEST_F(Cia402RobotsTest, EmergencyConcernsTheJointThatIsNamed) {
  make(config());
  (void)heard();
  ASSERT_TRUE(sut->execute(SendEmergency{0x8611, 0x21, {0, 2}}, now));
  sut->work(now);
  std::vector<std::uint32_t> ids;
  for (const CanFrame& frame : heard()) {
    if (frame.id < 0x100) ids.push_back(frame.id);
  }
  EXPECT_THAT(ids, ElementsAre(0x82U));
  EXPECT_FALSE(sut->execute(SendEmergency{0x8611, 0x21, {9, 0}}, now));
}

TEST_F(Cia402RobotsTest, RefusesWhatItCannotDo) {
  make(config());
  EXPECT_FALSE(sut->execute(AddFault{*parse_fault("nan")}, now));
  EXPECT_FALSE(sut->execute(EndFaults{7, std::nullopt}, now));
  EXPECT_TRUE(sut->execute(EndFaults{}, now));
}

TEST_F(Cia402RobotsTest, FramesThatABusRefusesAreCounted) {
  make(config());
  bus.refuse_sends(3);
  run_until_ms(100);
  EXPECT_EQ(sut->status(now).refused, 3U);
}

}  // namespace
}  // namespace cellmirror::sim
