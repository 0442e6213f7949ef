// The mirror's role by script, with virtual time.
#include "drivers/can/cia402/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <deque>

#include "drivers/can/cia402/drive.hpp"
#include "tests/unit/can/frames.hpp"
#include "tests/unit/can/session_fixture.hpp"
#include "tests/unit/can/test_data.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(SessionTest, StartsItsNodesAtOpen) {
  start();
  EXPECT_EQ(out.take(), (Frames{frame(0x000, {0x01, 0x03}), frame(0x000, {0x01, 0x04})}));
  EXPECT_FALSE(sut->next_due().known());
}

TEST_F(SessionTest, OnlyListensWhereItShallNotStart) {
  config.start_nodes = false;
  start();
  sut->receive(frame(0x703, {0x00}), now);
  EXPECT_TRUE(out.take().empty());
}

TEST_F(SessionTest, EventDrivenTpdoMakesASampleAtOnce) {
  config.nodes[1].sign = -1.0;
  config.nodes[1].offset = 0.5;
  start();
  tpdo(4, -2000);
  ASSERT_EQ(out.samples.size(), 1U);
  EXPECT_EQ(out.samples[0].present, 2U);
  EXPECT_EQ(out.samples[0].sequence, 1U);
  EXPECT_EQ(out.samples[0].receive_time, now);
  EXPECT_FALSE(out.samples[0].source_time.known());
  EXPECT_DOUBLE_EQ(out.samples[0].position[1], 2.5);
  EXPECT_EQ(sut->nodes()[1].state, Cia402State::operation_enabled);
}

TEST_F(SessionTest, TheCounterOfAContinuousJointContinuesAcrossItsWrap) {
  config.nodes[0].turns = true;
  start();
  tpdo(3, std::numeric_limits<std::int32_t>::max() - 10);
  tpdo(3, std::numeric_limits<std::int32_t>::min() + 9);
  ASSERT_EQ(out.samples.size(), 2U);
  EXPECT_NEAR(out.samples[1].position[0] - out.samples[0].position[0], 0.020, 1e-9);
  tpdo(3, std::numeric_limits<std::int32_t>::max() - 10);
  EXPECT_NEAR(out.samples[2].position[0], out.samples[0].position[0], 1e-9) << "and back";
  tpdo(4, std::numeric_limits<std::int32_t>::max());
  tpdo(4, std::numeric_limits<std::int32_t>::min());
  EXPECT_LT(out.samples[4].position[1], 0) << "the position of a joint with a range is not continued";
}

TEST_F(SessionTest, CountersOfAnyLengthAndRangeContinueAcrossTheirWrap) {
  struct Case {
    std::uint8_t bits;
    std::int64_t lower, upper;
    std::int64_t before, after, step;
  };
  for (const Case& one : {Case{16, 0, 0, 32'760, -32'770 + 4, 6 + 4}, Case{24, 0, 0, 8'388'600, -8'388'600, 16},
                          Case{32, 0, 3599, 3590, 9, 19}, Case{32, -1800, 1799, -1795, 1790, -15}}) {
    out.samples.clear();
    config.nodes[0].turns = true;
    config.nodes[0].range_lower = one.lower;
    config.nodes[0].range_upper = one.upper;
    config.nodes[0].tpdos = {{.number = 1, .entries = {{0x6064, 0, one.bits}}}};
    start();
    for (const std::int64_t counter : {one.before, one.after}) {
      CanFrame sent = frame(0x183, {0, 0, 0, 0});
      sent.length = one.bits / 8;
      put_le(sent.data, static_cast<std::uint64_t>(counter), 4);
      sut->receive(sent, now);
    }
    ASSERT_EQ(out.samples.size(), 2U);
    EXPECT_NEAR(out.samples[1].position[0] - out.samples[0].position[0], 0.001 * static_cast<double>(one.step), 1e-9)
        << int{one.bits};
  }
}

TEST_F(SessionTest, TheCounterOfADriveThatBootsIsNotContinued) {
  config.nodes[0].turns = true;
  start();
  tpdo(3, std::numeric_limits<std::int32_t>::max() - 10);
  sut->receive(frame(0x703, {0x00}), now);
  tpdo(3, std::numeric_limits<std::int32_t>::min() + 10);
  EXPECT_LT(out.samples.back().position[0], 0);
}

TEST_F(SessionTest, VelocityAndTorqueComeWithTheirScales) {
  config.nodes[0].tpdos = {{.number = 1, .entries = {{0x6064, 0, 32}, {0x606C, 0, 32}}},
                           {.number = 2, .entries = {{0x6077, 0, 16}}}};
  config.nodes[0].sign = -1.0;
  config.nodes[0].torque_scale = 0.1;
  start();
  sut->receive(frame(0x283, {0xF6, 0xFF}), now);  // torque -10: no sample without a position
  EXPECT_TRUE(out.samples.empty());
  sut->receive(frame(0x183, {0xE8, 0x03, 0, 0, 0x18, 0xFC, 0xFF, 0xFF}), now);  // 1000, -1000
  ASSERT_EQ(out.samples.size(), 1U);
  EXPECT_DOUBLE_EQ(out.samples[0].position[0], -1.0);
  EXPECT_DOUBLE_EQ(out.samples[0].velocity[0], 1.0) << "velocity_scale 0: the position's scale";
  EXPECT_DOUBLE_EQ(out.samples[0].effort[0], 1.0);
}

TEST_F(SessionTest, VelocityAndTorqueThatStoppedToComeAreNotKnownAnyMore) {
  config.nodes[0].tpdos = {{.number = 1, .entries = {{0x6064, 0, 32}}},
                           {.number = 2, .entries = {{0x606C, 0, 32}, {0x6077, 0, 16}}}};
  config.nodes[0].torque_scale = 0.1;
  start();
  const CanFrame position = frame(0x183, {0xE8, 0x03, 0, 0});
  sut->receive(frame(0x283, {0xE8, 0x03, 0, 0, 10, 0}), now);
  now = now + config.ages.lost_after;
  sut->receive(position, now);
  EXPECT_DOUBLE_EQ(out.samples.back().velocity[0], 1.0);
  EXPECT_DOUBLE_EQ(out.samples.back().effort[0], 1.0);
  now = now + 1ns;
  sut->receive(position, now);
  EXPECT_EQ(out.samples.back().velocity[0], 0.0);
  EXPECT_EQ(out.samples.back().effort[0], 0.0);
  sut->receive(frame(0x283, {0xE8, 0x03, 0, 0, 20, 0}), now);
  sut->receive(position, now);
  EXPECT_DOUBLE_EQ(out.samples.back().effort[0], 2.0);
}

TEST_F(SessionTest, ProducesSyncWithItsPhase) {
  config.sync_period = 10ms;
  start();
  out.take();
  EXPECT_EQ(sut->next_due(), now + 10ms);
  at(9ms);
  EXPECT_TRUE(out.take().empty());
  at(2ms);  // 1 ms late
  EXPECT_EQ(out.take(), (Frames{frame(0x080, {})}));
  at(8ms);  // 19 ms
  EXPECT_TRUE(out.take().empty());
  at(1ms);  // 20 ms: the phase is kept
  EXPECT_EQ(out.take().size(), 1U);
  at(35ms);  // 30, 40 and 50 ms became one
  EXPECT_EQ(out.take().size(), 1U);
  EXPECT_EQ(sut->counters().syncs_missed, 2U);
  EXPECT_EQ(sut->next_due().ns, 10'060'000'000);
}

TEST_F(SessionTest, OneSampleACycleWhenAllNodesHaveAnswered) {
  config.sync_period = 10ms;
  start();
  at(10ms);
  tpdo(3, 1);  // the first answers: nobody is waited for yet
  tpdo(4, 2);
  out.samples.clear();
  at(10ms);
  tpdo(4, 20);
  EXPECT_TRUE(out.samples.empty());
  tpdo(3, 10);
  ASSERT_EQ(out.samples.size(), 1U);
  EXPECT_EQ(out.samples[0].present, 3U);
  EXPECT_DOUBLE_EQ(out.samples[0].position[0], 0.010);
  EXPECT_DOUBLE_EQ(out.samples[0].position[1], 0.020);
}

TEST_F(SessionTest, AMissingTpdoIsLostAndTheOthersComeWithTheNextSync) {
  config.sync_period = 10ms;
  start();
  at(10ms);
  tpdo(3, 1);
  tpdo(4, 2);
  out.samples.clear();
  at(10ms);
  tpdo(3, 10);
  EXPECT_TRUE(out.samples.empty());
  at(10ms);
  ASSERT_EQ(out.samples.size(), 1U);
  EXPECT_EQ(out.samples[0].present, 1U);
  EXPECT_EQ(sut->counters().lost, 1U);
  EXPECT_THAT(out.events.back().text, HasSubstr("node 4 (J_2): TPDO1 did not follow a SYNC"));
}

TEST_F(SessionTest, SyncOfAnotherProducerMakesCyclesToo) {
  for (auto& n : config.nodes)
    n.tpdos = {{.number = 1, .transmission_type = 1, .entries = {{0x6041, 0, 16}, {0x6064, 0, 32}}}};
  start();
  for (int i = 0; i < 3; ++i) {
    sut->receive(frame(0x080, {}), now);
    tpdo(3, i);
    tpdo(4, i);
  }
  EXPECT_EQ(out.samples.back().present, 3U);
  EXPECT_EQ(sut->counters().syncs, 3U);
  EXPECT_EQ(sut->counters().lost, 0U);
  sut->receive(frame(0x080, {}), now);
  sut->receive(frame(0x080, {}), now);
  EXPECT_EQ(sut->counters().lost, 2U);
}

TEST_F(SessionTest, AnAcyclicTpdoThatStaysOutIsNoLoss) {
  config.nodes = {node(3, 0)};
  config.nodes[0].tpdos = {{.number = 1, .transmission_type = 0, .entries = {{0x6041, 0, 16}, {0x6064, 0, 32}}}};
  config.sync_period = 10ms;
  start();
  at(10ms);
  tpdo(3, 1);
  EXPECT_EQ(out.samples.size(), 1U);
  for (int i = 0; i < 5; ++i) at(10ms);
  EXPECT_EQ(sut->counters().lost, 0U);
}

TEST_F(SessionTest, SynchronousTpdosWithoutAnySyncAreTakenAsTheyCome) {
  config.nodes[0].tpdos = {{.number = 1, .transmission_type = 1, .entries = {{0x6041, 0, 16}, {0x6064, 0, 32}}}};
  start();
  tpdo(3, 7);
  EXPECT_EQ(out.samples.size(), 1U);
}

TEST_F(SessionTest, WhileTheBusRefusesSyncNothingCountsAsLost) {
  config.sync_period = 10ms;
  start();
  for (int i = 0; i < 2; ++i) {
    at(10ms);
    tpdo(3, i);
    tpdo(4, i);
  }
  out.bus_works = false;
  for (int i = 0; i < 5; ++i) at(10ms);
  EXPECT_EQ(sut->counters().lost, 0U);
  EXPECT_EQ(sut->counters().syncs_missed, 5U);
}

TEST_F(SessionTest, BootUpAtAnyTimeIsAnsweredWithNmtStart) {
  start();
  out.take();
  at(5s);
  sut->receive(frame(0x704, {0x00}), now);
  EXPECT_EQ(out.take(), (Frames{frame(0x000, {0x01, 0x04})}));
  EXPECT_THAT(out.kinds(), ElementsAre(Cia402EventKind::boot_up));
  EXPECT_EQ(sut->nodes()[1].boot_ups, 1U);
}

TEST_F(SessionTest, ANodeThatStaysPreOperationalIsStartedOnceASecond) {
  start();
  out.take();
  for (int i = 0; i < 35; ++i) {
    now = now + 100ms;
    sut->receive(frame(0x703, {0x7F}), now);
  }
  EXPECT_EQ(out.take().size(), 3U);
  sut->receive(frame(0x703, {0x04}), now + 5s);
  EXPECT_TRUE(out.take().empty()) << "stopped on purpose";
}

TEST_F(SessionTest, HeartbeatLostAndResolved) {
  config.heartbeat_timeout = 500ms;
  start();
  sut->receive(frame(0x703, {0x05}), now);
  sut->receive(frame(0x704, {0x05}), now);
  EXPECT_EQ(sut->next_due(), now + 500ms);
  now = now + 400ms;
  sut->receive(frame(0x704, {0x05}), now);
  at(100ms);
  EXPECT_THAT(out.kinds(), ElementsAre(Cia402EventKind::node_lost));
  at(200ms);
  EXPECT_EQ(condition(sut->nodes(), now + 500ms), "node 3 (J_1): no heartbeat since 1.2 s");
  sut->receive(frame(0x703, {0x05}), now);
  EXPECT_THAT(out.kinds(), ElementsAre(Cia402EventKind::node_resolved));
  EXPECT_EQ(condition(sut->nodes(), now), "operational");
}

TEST_F(SessionTest, ALostNodeIsNotWaitedFor) {
  config.sync_period = 10ms;
  config.heartbeat_timeout = 50ms;
  start();
  for (int i = 0; i < 20; ++i) {
    at(10ms);
    sut->receive(frame(0x703, {0x05}), now);
    tpdo(3, i);
    if (i < 2) {
      sut->receive(frame(0x704, {0x05}), now);
      tpdo(4, i);
    }
  }
  EXPECT_EQ(out.samples.back().receive_time, now) << "the sample came with the last answer, not with the next SYNC";
  EXPECT_LE(sut->counters().lost, 5U) << "only until the heartbeat was missed";
}

TEST_F(SessionTest, ANodeThatSleepsIsNotWaitedFor) {
  config.sync_period = 10ms;
  start();
  for (int i = 0; i < 3; ++i) {
    at(10ms);
    tpdo(3, i);
    tpdo(4, i);
  }
  sut->receive(frame(0x704, {0x04}), now);  // stopped on purpose
  for (int i = 0; i < 5; ++i) {
    at(10ms);
    out.samples.clear();
    tpdo(3, i);
    EXPECT_EQ(out.samples.size(), 1U) << "complete with node 3 alone";
  }
  EXPECT_EQ(sut->counters().lost, 0U);
}

TEST_F(SessionTest, ALostNodeMissesNothing) {
  config.sync_period = 10ms;
  config.heartbeat_timeout = 15ms;
  start();
  at(10ms);
  sut->receive(frame(0x703, {0x05}), now);
  sut->receive(frame(0x704, {0x05}), now);
  tpdo(3, 1);
  tpdo(4, 1);
  std::uint64_t lost_when_known = 0;
  for (int i = 0; i < 10; ++i) {
    at(10ms);
    sut->receive(frame(0x703, {0x05}), now);
    tpdo(3, i);
    if (i == 3) lost_when_known = sut->counters().lost;
  }
  EXPECT_EQ(sut->counters().lost, lost_when_known) << "its heartbeat is lost: nothing is expected of it";
}

TEST_F(SessionTest, ShortAnswersBySdoAreRejected) {
  config.nodes = {node(3, 0)};
  config.nodes[0].configure = true;
  start();
  out.take();
  sut->receive(frame(0x583, {0x60, 0x00, 0x18}), now);
  EXPECT_EQ(sut->counters().rejected, 1U);
  EXPECT_THAT(out.events.back().text, HasSubstr("SDO answer of 3 bytes instead of 8"));
}

TEST_F(SessionTest, EmcyIsTold) {
  start();
  sut->receive(frame(0x083, {0x11, 0x86, 0x21, 0, 0, 0, 0, 0}), now);
  EXPECT_EQ(out.events.back().text, "node 3 (J_1): EMCY node 3 0x8611 following error, register 0x21");
  EXPECT_EQ(sut->nodes()[0].last_emcy->code, 0x8611);
}

TEST_F(SessionTest, FaultOfADriveShowsInTheCondition) {
  start();
  sut->receive(frame(0x703, {0x05}), now);
  sut->receive(frame(0x704, {0x05}), now);
  tpdo(4, 0);
  sut->receive(frame(0x183, {0x38, 0x02, 0, 0, 0, 0}), now);
  EXPECT_EQ(condition(sut->nodes(), now), "node 3 (J_1): operational, fault");
}

TEST_F(SessionTest, WrongLengthsAreRejectedAndCounted) {
  start();
  out.samples.clear();
  sut->receive(frame(0x183, {0x37, 0x02, 0, 0, 0}), now);
  sut->receive(frame(0x183, {0x37, 0x02, 0, 0, 0, 0, 0, 0}), now);
  sut->receive(frame(0x703, {0x05, 0x05}), now);
  sut->receive(frame(0x083, {0x11}), now);
  EXPECT_EQ(sut->counters().rejected, 4U);
  EXPECT_TRUE(out.samples.empty());
  EXPECT_EQ(out.events[0].text, "node 3 (J_1): TPDO1 of 5 bytes, its mapping has 6");
}

TEST_F(SessionTest, FramesOfOthersAreNone) {
  start();
  tpdo(9, 1);
  CanFrame foreign = extended_frame(0x183, {0x37, 0x02, 0, 0, 0, 0});
  sut->receive(foreign, now);
  foreign = frame(0x183, {});
  foreign.remote = true;
  sut->receive(foreign, now);
  EXPECT_TRUE(out.samples.empty());
  EXPECT_EQ(sut->counters().rejected, 0U);
}

TEST_F(SessionTest, TpdoWithA29BitIdentifier) {
  config.nodes[0].tpdos = {{.number = 1, .cob_id = 0x20012345, .entries = {{0x6064, 0, 32}}}};
  start();
  sut->receive(extended_frame(0x12345, {1, 0, 0, 0}), now);
  EXPECT_EQ(out.samples.size(), 1U);
}

TEST_F(SessionTest, ConfiguresByTheStepsOfTheStandard) {
  config.nodes = {node(3, 0)};
  config.nodes[0].configure = true;
  config.nodes[0].tpdos = {{.number = 1, .transmission_type = 1, .entries = {{0x6064, 0, 32}}}};
  config.heartbeat_producer_ms = 100;
  start();
  const Frames requests = {
      frame(0x603, {0x23, 0x00, 0x18, 0x01, 0x83, 0x01, 0x00, 0xC0}),  // the PDO off
      frame(0x603, {0x2F, 0x00, 0x1A, 0x00, 0, 0, 0, 0}),
      frame(0x603, {0x23, 0x00, 0x1A, 0x01, 0x20, 0x00, 0x64, 0x60}),
      frame(0x603, {0x2F, 0x00, 0x1A, 0x00, 1, 0, 0, 0}),
      frame(0x603, {0x2F, 0x00, 0x18, 0x02, 1, 0, 0, 0}),
      frame(0x603, {0x2B, 0x00, 0x18, 0x03, 0, 0, 0, 0}),
      frame(0x603, {0x2B, 0x00, 0x18, 0x05, 0, 0, 0, 0}),
      frame(0x603, {0x23, 0x00, 0x18, 0x01, 0x83, 0x01, 0x00, 0x40}),  // and on again
      frame(0x603, {0x2B, 0x17, 0x10, 0x00, 0x64, 0, 0, 0}),
  };
  EXPECT_EQ(out.take(), (Frames{frame(0x000, {0x80, 0x03}), requests[0]}));
  for (std::size_t i = 0; i < requests.size(); ++i) {
    CanFrame answer = frame(0x583, {0x60, requests[i].data[1], requests[i].data[2], requests[i].data[3], 0, 0, 0, 0});
    if (i == 6) {  // no event timer in this drive: an optional step
      answer = frame(0x583, {0x80, 0x00, 0x18, 0x05, 0x11, 0x00, 0x09, 0x06});
    }
    sut->receive(answer, now);
    const Frames sent = out.take();
    ASSERT_EQ(sent.size(), 1U) << i;
    EXPECT_EQ(sent[0], i + 1 < requests.size() ? requests[i + 1] : frame(0x000, {0x01, 0x03}));
  }
  EXPECT_THAT(out.kinds(), ElementsAre(Cia402EventKind::configured));
}

TEST_F(SessionTest, ARefusedConfigurationLeavesTheNodeUnstartedAndIsRetried) {
  config.nodes = {node(3, 0)};
  config.nodes[0].configure = true;
  start();
  out.take();
  sut->receive(frame(0x583, {0x80, 0x00, 0x18, 0x01, 0x02, 0x00, 0x01, 0x06}), now);
  EXPECT_TRUE(out.take().empty());
  EXPECT_EQ(
      condition(sut->nodes(), now),
      "node 3 (J_1): configuration failed: the SDO write of 0x1800:01 was refused: 0x06010002 write of a read-only "
      "object");
  at(4999ms);
  EXPECT_TRUE(out.take().empty());
  at(1ms);
  EXPECT_EQ(out.take().size(), 2U);
}

TEST_F(SessionTest, AnSdoTimeoutIsRetriedUntilTheNodeIsThere) {
  config.nodes = {node(3, 0)};
  config.nodes[0].configure = true;
  start();
  out.take();
  at(500ms);
  EXPECT_EQ(out.take(), (Frames{frame(0x603, {0x80, 0x00, 0x18, 0x01, 0x00, 0x00, 0x04, 0x05})}));
  at(1s);
  EXPECT_EQ(out.take()[0], frame(0x000, {0x80, 0x03}));
  sut->receive(frame(0x703, {0x00}), now);
  EXPECT_EQ(out.take()[0], frame(0x000, {0x80, 0x03})) << "boot-up starts over at once";
}

TEST_F(SessionTest, ADriveThatIsPreOperationalAfterAMissedBootUpIsConfiguredAgain) {
  config.nodes = {node(3, 0)};
  config.nodes[0].configure = true;
  config.heartbeat_timeout = 500ms;
  for (const bool is_told_lost : {true, false}) {
    start();
    accept_configuration();
    sut->receive(frame(0x703, {0x05}), now);
    now = now + 2s;
    if (is_told_lost) sut->advance(now);
    ASSERT_TRUE(out.take().empty());
    sut->receive(frame(0x703, {0x7F}), now);
    const Frames sent = out.take();
    ASSERT_EQ(sent.size(), 2U) << is_told_lost;
    EXPECT_EQ(sent[0], frame(0x000, {0x80, 0x03}));
    EXPECT_EQ(sent[1].id, 0x603U);
  }
}

TEST_F(SessionTest, AConfiguredDriveThatMissedItsStartIsOnlyStartedAgain) {
  config.nodes = {node(3, 0)};
  config.nodes[0].configure = true;
  start();
  accept_configuration();
  for (int i = 0; i < 3; ++i) {
    now = now + 2s;
    sut->receive(frame(0x703, {0x7F}), now);
    EXPECT_EQ(out.take(), (Frames{frame(0x000, {0x01, 0x03})}));
  }
}

TEST_F(SessionTest, MappingOfTheEdsIsUsed) {
  config.nodes = {node(3, 0)};
  config.nodes[0].eds_file = can_data("drive.dcf");
  start();
  tpdo(3, 1000);
  ASSERT_EQ(out.samples.size(), 1U);
  EXPECT_DOUBLE_EQ(out.samples[0].position[0], 1.0);
}

// Both roles against each other on a bus of a queue, one millisecond a step.
TEST_F(SessionTest, MirrorAndDrivesFindEachOther) {
  struct Bus : Cia402DriveOutput {
    std::deque<CanFrame> frames;
    void send(const CanFrame& frame) override { frames.push_back(frame); }
  } bus;
  config.sync_period = 5ms;
  config.heartbeat_timeout = 50ms;
  config.heartbeat_producer_ms = 20;
  for (auto& n : config.nodes) {
    n.configure = true;
    n.tpdos = {{.number = 1, .transmission_type = 1, .entries = {{0x6041, 0, 16}, {0x6064, 0, 32}}},
               {.number = 2, .transmission_type = 1, .entries = {{0x606C, 0, 32}, {0x6077, 0, 16}}}};
  }
  Cia402DriveConfig drive_config;
  drive_config.node_id = 3;
  Cia402Drive drive_3(drive_config, bus);
  drive_config.node_id = 4;
  Cia402Drive drive_4(drive_config, bus);
  start();
  const auto run = [&](int ms) {
    for (int i = 0; i < ms; ++i) {
      now = now + 1ms;
      sut->advance(now);
      for (Cia402Drive* drive : {&drive_3, &drive_4}) {
        for (const CanFrame& f : Frames(out.frames)) drive->receive(f, now);
        drive->advance(now);
      }
      out.frames.clear();
      while (!bus.frames.empty()) {
        sut->receive(bus.frames.front(), now);
        bus.frames.pop_front();
      }
    }
  };
  drive_3.power_on(now);
  run(300);
  EXPECT_EQ(drive_3.nmt_state(), NmtState::operational);
  EXPECT_THAT(condition(sut->nodes(), now), HasSubstr("node 4 (J_2)"));
  drive_4.power_on(now);  // boot-up at any time
  drive_4.set_actual(5000, -100, 0, now);
  run(300);
  EXPECT_EQ(condition(sut->nodes(), now), "operational");
  EXPECT_DOUBLE_EQ(out.samples.back().position[1], 5.0);
  EXPECT_DOUBLE_EQ(out.samples.back().velocity[1], -0.1);
  EXPECT_EQ(out.samples.back().present, 3U);
  const std::uint64_t lost = sut->counters().lost;
  drive_3.power_off();
  run(200);
  EXPECT_GT(sut->counters().lost, lost);
  EXPECT_THAT(condition(sut->nodes(), now), HasSubstr("node 3 (J_1): "));
  drive_3.power_on(now);
  run(300);
  EXPECT_EQ(condition(sut->nodes(), now), "operational");
  EXPECT_EQ(sut->counters().rejected, 0U);
}

TEST(Cia402Plan, TellsAllMistakes) {
  Cia402StreamConfig config;
  config.nodes = {node(0, 0), node(3, 0), node(3, 0), node(4, 99), node(5, 5), node(6, 6)};
  config.nodes[4].scale = 0.0;
  config.nodes[4].sign = 2.0;
  config.nodes[5].tpdos = {{.number = 5, .entries = {{0x6041, 0, 16}}}};
  Diagnostics diagnostics;
  EXPECT_FALSE(plan_cia402(config, diagnostics));
  const std::string told = diagnostics.text();
  for (const char* expected :
       {"node 0 (J_1): node numbers go from 1 to 127", "node 3 (J_1): the node number appears twice",
        "node 3 (J_1): the joint has two nodes", "node 4 (J_100): joint 99 is beyond 16 joints",
        "node 5 (J_6): the scale has to be positive", "node 5 (J_6): the sign is 1 or -1",
        "node 6 (J_7): TPDO5 needs a COB-ID of its own",
        "node 6 (J_7): no TPDO holds the position actual value 0x6064"}) {
    EXPECT_THAT(told, HasSubstr(expected));
  }
}

TEST(Cia402Plan, TakesTheLastNodeJointAndIdentifierAndNoneBeyond) {
  const auto told = [](int id, std::size_t joint, std::uint32_t cob_id) {
    Cia402StreamConfig config;
    config.nodes = {node(id, joint)};
    config.nodes[0].tpdos = {{.number = 1, .cob_id = cob_id, .entries = {{0x6064, 0, 32}}}};
    Diagnostics diagnostics;
    return plan_cia402(config, diagnostics) ? std::string() : diagnostics.text();
  };
  EXPECT_EQ(told(127, kMaxJointsPerRobot - 1, 0x7FF), "");
  EXPECT_THAT(told(128, 0, 0x7FF), HasSubstr("node numbers go from 1 to 127"));
  EXPECT_THAT(told(1, kMaxJointsPerRobot, 0x7FF), HasSubstr("is beyond"));
  EXPECT_THAT(told(1, 0, 0x800), HasSubstr("0x800 is no COB-ID of 11 bits"));
}

TEST(Cia402Plan, MistakesStandAtTheNodeInTheCellFile) {
  Cia402StreamConfig config;
  config.nodes = {node(6, 0)};
  config.nodes[0].place = {"cell.toml", 20, 1};
  config.nodes[0].tpdos = {{.number = 5, .entries = {{0x6041, 0, 16}}}};
  Diagnostics diagnostics;
  EXPECT_FALSE(plan_cia402(config, diagnostics));
  EXPECT_THAT(diagnostics.text(), HasSubstr("cell.toml:20:1: error: node 6 (J_1): TPDO5 needs a COB-ID"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("cell.toml:20:1: error: node 6 (J_1): no TPDO holds"));
}

}  // namespace
}  // namespace cellmirror::can
