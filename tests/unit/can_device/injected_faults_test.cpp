// Faults that are injected into nodes: a drive without power, an error, frames that vanish or come late, inputs that
// are stuck.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>
#include <vector>

#include "drivers/can/canopen/fault_gate.hpp"
#include "drivers/can/cia401/io_node.hpp"
#include "tests/unit/can/frames.hpp"
#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

struct InjectedFaults : testing::Test {
  [[nodiscard]] std::size_t sent(std::uint32_t id) const {
    return static_cast<std::size_t>(std::ranges::count(master.frames, id, &CanFrame::id));
  }
  void inject(NodeFault fault) { master.drive.inject(fault, master.now); }

  DriveMaster master;  // node 5
};

TEST_F(InjectedFaults, WithoutPowerADriveIsSilentAndDeafThenItBoots) {
  EXPECT_EQ(master.write16(0x1017, 10), 0U);
  master.enable();
  master.mode(3);
  master.write32(0x60FF, 1000);
  master.run(100ms);
  EXPECT_GT(master.drive.joint_velocity(), 0.5);
  inject({.kind = NodeFaultKind::death, .lasts = 500ms});
  master.take();
  master.run(400ms);
  master.receive(frame(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));
  EXPECT_TRUE(master.frames.empty());
  EXPECT_EQ(master.drive.joint_velocity(), 0) << "the brake holds";
  master.run(101ms);
  EXPECT_EQ(sent(0x705), 1U) << "boot-up";
  EXPECT_EQ(master.drive.nmt_state(), NmtState::pre_operational);
  EXPECT_EQ(master.drive.state(), Cia402State::switch_on_disabled);
  EXPECT_EQ(master.object(0x1017), 0) << "values of power-on";
}

TEST_F(InjectedFaults, AnErrorIsAFaultThatTheMasterResets) {
  master.enable();
  master.take();
  inject({.kind = NodeFaultKind::emergency, .code = 0x2310});
  EXPECT_EQ(master.emergencies(), std::vector<std::uint16_t>{0x2310});
  EXPECT_EQ(master.object(0x1001), 0x03);
  master.run(100ms);
  EXPECT_EQ(master.drive.state(), Cia402State::fault);
  EXPECT_EQ(master.object(0x603F), 0x2310);
  master.control(0x80);
  EXPECT_EQ(master.drive.state(), Cia402State::switch_on_disabled);
}

TEST_F(InjectedFaults, OnlyHeartbeatsVanish) {
  EXPECT_EQ(master.write16(0x1017, 10), 0U);
  inject({.kind = NodeFaultKind::loss, .lasts = 200ms, .only = NodeFrames::heartbeat});
  master.take();
  master.run(190ms);
  EXPECT_EQ(sent(0x705), 0U);
  EXPECT_EQ(master.read_abort(0x1000, 0), 0U);
  EXPECT_EQ(sent(0x585), 1U);
  master.run(50ms);
  EXPECT_GE(sent(0x705), 3U) << "they are back";
}

TEST_F(InjectedFaults, AnswersComeLate) {
  inject({.kind = NodeFaultKind::delay, .only = NodeFrames::sdo, .by = 50ms});
  EXPECT_EQ(master.read_abort(0x1000, 0), 0U);
  EXPECT_EQ(sent(0x585), 0U);
  master.run(49ms);
  EXPECT_EQ(sent(0x585), 0U);
  EXPECT_EQ(master.drive.next_timer(), master.now + 1ms);
  master.run(2ms);
  EXPECT_EQ(sent(0x585), 1U);
  EXPECT_EQ(master.read_abort(0x1000, 0), 0U);
  master.drive.end_faults(master.now);
  EXPECT_EQ(sent(0x585), 1U) << "what waited leaves at once";
  EXPECT_EQ(master.drive.faults().kinds(), 0);
}

TEST_F(InjectedFaults, AProbabilityTakesItsShare) {
  inject({.kind = NodeFaultKind::loss, .probability = 0.5});
  for (int i = 0; i < 1000; ++i) master.receive(frame(0x605, {0x40, 0, 0x10, 0, 0, 0, 0, 0}));
  EXPECT_GT(sent(0x585), 400U);
  EXPECT_LT(sent(0x585), 600U);
}

TEST_F(InjectedFaults, AreBounded) {
  for (std::size_t i = 0; i < 2 * FaultGate::kMostFaults; ++i) inject({.kind = NodeFaultKind::delay, .by = 10s});
  for (int i = 0; i < 1000; ++i) master.receive(frame(0x605, {0x40, 0, 0x10, 0, 0, 0, 0, 0}));
  master.take();
  master.drive.end_faults(master.now);
  EXPECT_EQ(sent(0x585), FaultGate::kMostWaiting);
}

struct InjectedIo : testing::Test, FrameOutput {
  InjectedIo() { node.power_on(now); }
  void send(const CanFrame& sent) override { frames.push_back(sent); }
  std::vector<CanFrame> take(std::uint32_t id) {
    std::vector<CanFrame> found;
    std::ranges::copy_if(std::exchange(frames, {}), std::back_inserter(found),
                         [id](const CanFrame& sent) { return sent.id == id; });
    return found;
  }
  void see(std::uint32_t digital) {
    now = now + 1ms;
    node.set_inputs({.digital = digital, .analogue = {}}, now);
    node.advance(now);
  }

  Timestamp now{1'000'000'000};
  std::vector<CanFrame> frames;
  IoNode node{7, 0, *this};
};

TEST_F(InjectedIo, AnInputIsStuck) {
  node.receive(frame(0x000, {0x01, 0x07}), now);
  take(0);
  node.inject({.kind = NodeFaultKind::stuck, .lasts = 10ms, .input = 1, .value = 1}, now);
  see(0);
  const auto stuck = take(0x187);
  ASSERT_EQ(stuck.size(), 1U) << "a controller sees it come";
  EXPECT_EQ(stuck[0].data[0], 0x02);
  see(0x03);
  EXPECT_EQ(take(0x187).at(0).data[0], 0x03) << "the others are as they are";
  for (int i = 0; i < 10; ++i) see(0);
  EXPECT_EQ(node.objects().integer({0x6000, 1}), 0) << "it is over";
  node.inject({.kind = NodeFaultKind::stuck, .analogue = true, .input = 2, .value = -5}, now);
  node.inject({.kind = NodeFaultKind::stuck, .input = 0, .value = 0}, now);
  see(0x01);
  EXPECT_EQ(node.objects().integer({0x6401, 3}), -5);
  EXPECT_EQ(node.objects().integer({0x6000, 1}), 0);
}

TEST_F(InjectedIo, AnErrorIsReportedUntilItEnds) {
  take(0);
  node.inject({.kind = NodeFaultKind::emergency, .lasts = 5ms, .code = 0x3110}, now);
  const auto raised = take(0x087);
  ASSERT_EQ(raised.size(), 1U);
  EXPECT_EQ(raised[0].data[1], 0x31);
  EXPECT_EQ(raised[0].data[2], 0x05);
  for (int i = 0; i < 6; ++i) see(0);
  const auto over = take(0x087);
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(over[0].data[1], 0);
  EXPECT_EQ(node.objects().integer({0x1001, 0}), 0);
}

}  // namespace
}  // namespace cellmirror::can
