// Drives that are lost: a drive as sim_robot has it, on a bus that can be cut. Virtual time, one millisecond a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <utility>

#include "drivers/can/cia402/drive.hpp"
#include "drivers/can/cia402/session.hpp"
#include "tests/unit/can/frames.hpp"
#include "tests/unit/can/session_fixture.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

struct LostDriveTest : SessionTest {
  struct Bus : Cia402DriveOutput {
    std::deque<CanFrame> frames;
    void send(const CanFrame& frame) override { frames.push_back(frame); }
  };
  Bus bus;
  Cia402Drive drive{number_3(), bus};
  Frames sent;  // by the mirror, all of them
  bool cut = false;

  static Cia402DriveConfig number_3() {
    Cia402DriveConfig drive_config;
    drive_config.node_id = 3;
    return drive_config;
  }
  LostDriveTest() {
    config.nodes = {node(3, 0)};
    config.heartbeat_timeout = 50ms;
  }
  void run(Nanoseconds time) {
    for (const Timestamp end = now + time; now < end;) {
      now = now + 1ms;
      sut->advance(now);
      const Frames frames = out.take();
      sent.insert(sent.end(), frames.begin(), frames.end());
      for (const CanFrame& f : frames) {
        if (!cut) drive.receive(f, now);
      }
      drive.advance(now);
      for (const CanFrame& f : std::exchange(bus.frames, {})) {
        if (!cut) sut->receive(f, now);
      }
    }
  }
  void lose_power_unheard() {
    cut = true;
    drive.power_off();
    run(100ms);
    drive.power_on(now);
    run(100ms);
    cut = false;
  }
  // Starts the stream and the drive, which has come up then.
  void come_up() {
    start();
    drive.power_on(now);
    run(500ms);
    ASSERT_EQ(drive.nmt_state(), NmtState::operational);
  }
  [[nodiscard]] auto writes() const {
    return std::ranges::count_if(sent, [](const CanFrame& f) { return f.id == 0x603 && f.data[0] >> 5 == 1; });
  }
};

TEST_F(LostDriveTest, OneThatSendsOnlyTheHeartbeatItWasConfiguredWithIsConfiguredAgain) {
  config.nodes[0].configure = true;
  config.heartbeat_producer_ms = 20;
  config.sync_period = 5ms;
  config.nodes[0].tpdos = {{.number = 1, .transmission_type = 1, .entries = {{0x6064, 0, 32}, {0x606C, 0, 32}}}};
  come_up();
  lose_power_unheard();
  EXPECT_EQ(drive.nmt_state(), NmtState::pre_operational);
  run(1500ms);
  EXPECT_EQ(condition(sut->nodes(), now), "operational");
  drive.set_actual(5000, -100, 0, now);
  run(10ms);
  EXPECT_DOUBLE_EQ(out.samples.back().position[0], 5.0);
  EXPECT_DOUBLE_EQ(out.samples.back().velocity[0], -0.1);
  EXPECT_EQ(sut->counters().rejected, 0U);
}

TEST_F(LostDriveTest, OneWithoutAnyHeartbeatIsConfiguredAgain) {
  config.nodes[0].configure = true;
  config.nodes[0].tpdos = {{.number = 1, .transmission_type = 255, .entries = {{0x6064, 0, 32}, {0x606C, 0, 32}}}};
  come_up();
  lose_power_unheard();
  run(1500ms);
  EXPECT_EQ(drive.nmt_state(), NmtState::operational);
  drive.set_actual(5000, -100, 0, now);
  run(10ms);
  EXPECT_DOUBLE_EQ(out.samples.back().velocity[0], -0.1);
}

// Nothing changes, so it sends nothing: it must not be taken out of operation.
TEST_F(LostDriveTest, OneThatStandsStillAndIsAsItWasConfiguredIsOnlyRead) {
  config.nodes[0].configure = true;
  config.nodes[0].tpdos = {{.number = 1, .transmission_type = 255, .entries = {{0x6064, 0, 32}}}};
  come_up();
  const auto written = writes();
  run(10s);
  EXPECT_EQ(writes(), written);
  EXPECT_EQ(std::ranges::count(sent, frame(0x000, {0x80, 0x03})), 2) << "at open and after its boot-up";
}

TEST_F(LostDriveTest, OneThatIsNotConfiguredIsStarted) {
  come_up();
  lose_power_unheard();
  run(1500ms);
  EXPECT_EQ(drive.nmt_state(), NmtState::operational);
  EXPECT_EQ(writes(), 0);
}

TEST_F(LostDriveTest, OneThatSomebodyStoppedIsLeftStopped) {
  come_up();
  drive.receive(frame(0x000, {0x02, 0x03}), now);
  run(5s);
  EXPECT_EQ(drive.nmt_state(), NmtState::stopped);
}

TEST_F(LostDriveTest, OneThatIsNotThereIsAskedOnceASecond) {
  start();
  run(100ms);
  sent.clear();
  run(10s);
  EXPECT_EQ(std::ranges::count(sent, frame(0x603, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0})), 10);
  EXPECT_LE(sent.size(), 20U) << "and the aborts of those that were not answered";
}

TEST_F(LostDriveTest, AStreamThatOnlyListensAsksNobody) {
  config.start_nodes = false;
  start();
  run(5s);
  EXPECT_TRUE(sent.empty());
  EXPECT_FALSE(sut->next_due().known());
}

}  // namespace
}  // namespace cellmirror::can
