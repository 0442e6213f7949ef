#include "drivers/can/cia402/drive.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/can/cia402/state.hpp"
#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

struct Sent : Cia402DriveOutput {
  std::vector<CanFrame> frames;
  void send(const CanFrame& frame) override { frames.push_back(frame); }
  std::vector<CanFrame> take() { return std::exchange(frames, {}); }
};

TEST(Statusword, DecodesTheStatesOfTheStandard) {
  EXPECT_EQ(decode_statusword(0x0000), Cia402State::not_ready_to_switch_on);
  EXPECT_EQ(decode_statusword(0x0250), Cia402State::switch_on_disabled);
  EXPECT_EQ(decode_statusword(0x0231), Cia402State::ready_to_switch_on);
  EXPECT_EQ(decode_statusword(0x0233), Cia402State::switched_on);
  EXPECT_EQ(decode_statusword(0x1637), Cia402State::operation_enabled);
  EXPECT_EQ(decode_statusword(0x0217), Cia402State::quick_stop_active);
  EXPECT_EQ(decode_statusword(0x021F), Cia402State::fault_reaction_active);
  EXPECT_EQ(decode_statusword(0x0238), Cia402State::fault);
  for (int s = 1; s <= 8; ++s) {
    const auto state = static_cast<Cia402State>(s);
    EXPECT_EQ(decode_statusword(statusword_bits(state)), state) << words(state);
  }
}

// Whether the lowest bits of a word are as `pattern` says, most significant first; x: either.
bool fits(unsigned word, std::string_view pattern) {
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char bit = (word >> (pattern.size() - 1 - i) & 1U) != 0 ? '1' : '0';
    if (pattern[i] != 'x' && pattern[i] != bit) return false;
  }
  return true;
}

// Every word, against the table of state coding (CiA 402-2, 6.4.3) as it is printed there.
TEST(Statusword, DecodesEveryWordAsTheTableOfTheStandard) {
  using enum Cia402State;
  const std::vector<std::pair<std::string_view, Cia402State>> table = {
      {"x0xx0000", not_ready_to_switch_on}, {"x1xx0000", switch_on_disabled},
      {"x01x0001", ready_to_switch_on},     {"x01x0011", switched_on},
      {"x01x0111", operation_enabled},      {"x00x0111", quick_stop_active},
      {"x0xx1111", fault_reaction_active},  {"x0xx1000", fault}};
  for (unsigned word = 0; word <= 0xFFFF; ++word) {
    Cia402State expected = unknown;
    for (const auto& [pattern, state] : table) {
      if (fits(word, pattern)) expected = state;
    }
    ASSERT_EQ(decode_statusword(static_cast<std::uint16_t>(word)), expected) << std::hex << word;
  }
}

// Every controlword in every state, against the commands and transitions of the standard (CiA 402-2, 6.4.2). Bit 7 off
// and on before makes no difference but to a fault.
TEST(Controlword, TakesEveryTransitionOfTheStandardAndNoOther) {
  using enum Cia402State;
  const std::string_view shutdown = "0xxxx110";
  const std::string_view switch_on = "0xxx0111";
  const std::string_view enable_operation = "0xxx1111";
  const std::string_view disable_voltage = "0xxxxx0x";
  const std::string_view quick_stop = "0xxxx01x";
  struct Transition {
    Cia402State from;
    std::string_view command;
    Cia402State to;
  };
  const std::vector<Transition> transitions = {
      {switch_on_disabled, shutdown, ready_to_switch_on},
      {ready_to_switch_on, switch_on, switched_on},
      {ready_to_switch_on, enable_operation, operation_enabled},  // through "switched on"
      {ready_to_switch_on, quick_stop, switch_on_disabled},
      {ready_to_switch_on, disable_voltage, switch_on_disabled},
      {switched_on, shutdown, ready_to_switch_on},
      {switched_on, enable_operation, operation_enabled},
      {switched_on, quick_stop, switch_on_disabled},
      {switched_on, disable_voltage, switch_on_disabled},
      {operation_enabled, switch_on, switched_on},
      {operation_enabled, shutdown, ready_to_switch_on},
      {operation_enabled, quick_stop, quick_stop_active},
      {operation_enabled, disable_voltage, switch_on_disabled},
      {quick_stop_active, enable_operation, operation_enabled},
      {quick_stop_active, disable_voltage, switch_on_disabled}};
  for (int s = 0; s <= 8; ++s) {
    const auto state = static_cast<Cia402State>(s);
    for (unsigned word = 0; word <= 0xFFFF; ++word) {
      for (const std::uint16_t before : {std::uint16_t{0}, std::uint16_t{0xFFFF}}) {
        Cia402State expected = state;
        for (const Transition& one : transitions) {
          if (one.from == state && fits(word, one.command)) expected = one.to;
        }
        if (state == fault && before == 0 && fits(word, "1xxxxxxx")) expected = switch_on_disabled;
        ASSERT_EQ(next_state(state, before, static_cast<std::uint16_t>(word)), expected)
            << words(state) << ", " << std::hex << word << " after " << before;
      }
    }
  }
  EXPECT_EQ(next_state(fault, 0x00, 0x80), switch_on_disabled);
  EXPECT_EQ(next_state(fault, 0x80, 0x80), fault) << "a fault is reset by the rising edge alone";
}

struct DriveTest : testing::Test {
  Sent sent;
  Cia402DriveConfig config;
  Timestamp now{1'000'000'000};

  Cia402Drive make() {
    config.node_id = 5;
    return Cia402Drive(config, sent);
  }
  void to_operational(Cia402Drive& sut) {
    sut.power_on(now);
    sut.receive(frame(0x000, {0x01, 0x05}), now);
    sent.take();
  }
};

TEST_F(DriveTest, BootsUpIntoPreOperational) {
  Cia402Drive sut = make();
  sut.receive(frame(0x000, {0x01, 0x05}), now);
  EXPECT_TRUE(sent.take().empty()) << "off";
  sut.power_on(now);
  EXPECT_EQ(sent.take(), (Frames{frame(0x705, {0x00})}));
  EXPECT_EQ(sut.nmt_state(), NmtState::pre_operational);
  sut.receive(frame(0x080, {}), now);
  EXPECT_TRUE(sent.take().empty()) << "no PDO before NMT start";
}

TEST_F(DriveTest, ObeysNmtForItselfAndForAll) {
  Cia402Drive sut = make();
  sut.power_on(now);
  sut.receive(frame(0x000, {0x01, 0x06}), now);
  EXPECT_EQ(sut.nmt_state(), NmtState::pre_operational);
  sut.receive(frame(0x000, {0x01, 0x00}), now);
  EXPECT_EQ(sut.nmt_state(), NmtState::operational);
  sut.receive(frame(0x000, {0x02, 0x05}), now);
  EXPECT_EQ(sut.nmt_state(), NmtState::stopped);
  sent.take();
  sut.receive(frame(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}), now);
  EXPECT_TRUE(sent.take().empty()) << "no SDO while stopped";
  sut.receive(frame(0x000, {0x81, 0x05}), now);
  EXPECT_EQ(sent.take(), (Frames{frame(0x705, {0x00})}));
}

TEST_F(DriveTest, AnswersSyncWithStatuswordAndPosition) {
  Cia402Drive sut = make();
  to_operational(sut);
  sut.set_actual(-2, 0, 0, now);
  sut.receive(frame(0x080, {}), now);
  // Switch on disabled, remote, target reached: 0x0640.
  EXPECT_EQ(sent.take(), (Frames{frame(0x185, {0x40, 0x06, 0xFE, 0xFF, 0xFF, 0xFF})}));
}

TEST_F(DriveTest, EveryNthSync) {
  config.tpdos = {{.number = 1, .transmission_type = 3, .entries = {{0x6064, 0, 32}}}};
  Cia402Drive sut = make();
  to_operational(sut);
  for (int i = 1; i <= 6; ++i) {
    sut.receive(frame(0x080, {}), now);
    EXPECT_EQ(sent.take().size(), i % 3 == 0 ? 1U : 0U) << i;
  }
}

TEST_F(DriveTest, EventTimerKeepsItsPeriod) {
  config.tpdos = {{.number = 1, .event_timer_ms = 10, .entries = {{0x6064, 0, 32}}}};
  Cia402Drive sut = make();
  to_operational(sut);
  int frames = 0;
  for (int ms = 1; ms <= 100; ++ms) {
    sut.set_actual(ms, 0, 0, now + std::chrono::milliseconds(ms));
    sut.advance(now + std::chrono::milliseconds(ms));
    frames += static_cast<int>(sent.take().size());
  }
  EXPECT_EQ(frames, 10);
}

TEST_F(DriveTest, WithoutATimerAChangeIsSentAfterTheInhibitTime) {
  config.tpdos = {{.number = 1, .inhibit_time_100us = 50, .entries = {{0x6064, 0, 32}}}};  // 5 ms
  Cia402Drive sut = make();
  to_operational(sut);
  sut.set_actual(1, 0, 0, now + 1ms);
  EXPECT_TRUE(sent.take().empty()) << "the TPDO of entering operational is 1 ms old";
  EXPECT_EQ(sut.next_due(), now + 5ms);
  sut.set_actual(2, 0, 0, now + 2ms);
  sut.advance(now + 5ms);
  EXPECT_EQ(sent.take(), (Frames{frame(0x185, {2, 0, 0, 0})}));
  sut.advance(now + 20ms);
  EXPECT_TRUE(sent.take().empty());
}

TEST_F(DriveTest, HeartbeatPeriodComesFromItsObject) {
  Cia402Drive sut = make();
  sut.power_on(now);
  sent.take();
  EXPECT_FALSE(sut.next_due().known());
  sut.receive(frame(0x605, {0x2B, 0x17, 0x10, 0x00, 0x64, 0x00, 0, 0}), now);  // 100 ms
  sent.take();
  EXPECT_EQ(sut.next_due(), now + 100ms);
  sut.advance(now + 99ms);
  EXPECT_TRUE(sent.take().empty());
  sut.advance(now + 100ms);
  EXPECT_EQ(sent.take(), (Frames{frame(0x705, {0x7F})}));
}

TEST_F(DriveTest, HeartbeatsThatWereMissedAreNotMadeUpFor) {
  Cia402Drive sut = make();
  sut.power_on(now);
  sut.receive(frame(0x605, {0x2B, 0x17, 0x10, 0x00, 0x64, 0x00, 0, 0}), now);  // 100 ms
  sent.take();
  sut.advance(now + 100ms);
  EXPECT_EQ(sut.next_due(), now + 200ms) << "in time: the phase is kept";
  sent.take();
  sut.advance(now + 750ms);
  EXPECT_EQ(sent.take().size(), 1U);
  EXPECT_EQ(sut.next_due(), now + 850ms);
  sut.advance(now + 751ms);
  EXPECT_TRUE(sent.take().empty());
}

TEST_F(DriveTest, ControlwordByRpdoEnablesOperation) {
  config.follows_targets = true;
  Cia402Drive sut = make();
  to_operational(sut);
  const auto command = [&](int word, int target) {
    sut.receive(frame(0x205, {word, 0, target, 0, 0, 0}), now);
    sut.receive(frame(0x080, {}), now);  // RPDO1 is taken with SYNC
    return sut.state();
  };
  EXPECT_EQ(command(0x06, 0), Cia402State::ready_to_switch_on);
  EXPECT_EQ(command(0x07, 0), Cia402State::switched_on);
  EXPECT_EQ(command(0x0F, 0), Cia402State::operation_enabled);
  EXPECT_EQ(sut.position(), 0);
  command(0x0F, 100);
  EXPECT_EQ(sut.position(), 100) << "CSP";
}

TEST_F(DriveTest, ShortRpdoIsAnsweredWithEmcy) {
  Cia402Drive sut = make();
  to_operational(sut);
  sut.receive(frame(0x205, {0x06, 0x00}), now);
  EXPECT_EQ(sent.take(), (Frames{frame(0x085, {0x10, 0x82, 0x11, 0, 0, 0, 0, 0})}));
}

TEST_F(DriveTest, ProfilePositionMovesAndReachesTheTarget) {
  config.follows_targets = true;
  Cia402Drive sut = make();
  to_operational(sut);
  const auto write = [&](std::initializer_list<int> bytes) {
    sut.receive(frame(0x605, bytes), now);
    EXPECT_EQ(sent.take().back().data[0], 0x60);
  };
  write({0x2F, 0x60, 0x60, 0x00, 1, 0, 0, 0});        // profile position
  write({0x23, 0x81, 0x60, 0x00, 0xE8, 0x03, 0, 0});  // 1000 increments a second
  write({0x23, 0x7A, 0x60, 0x00, 0x64, 0, 0, 0});     // target 100
  for (const int word : {0x06, 0x07, 0x0F, 0x1F}) write({0x2B, 0x40, 0x60, 0x00, word, 0, 0, 0});
  EXPECT_NE(sut.statusword() & kStatuswordModeBit12, 0) << "set-point acknowledged";
  EXPECT_EQ(sut.statusword() & kStatuswordTargetReached, 0);
  sut.advance(now + 50ms);
  EXPECT_EQ(sut.position(), 50);
  sut.advance(now + 110ms);
  EXPECT_EQ(sut.position(), 100);
  EXPECT_NE(sut.statusword() & kStatuswordTargetReached, 0);
}

TEST_F(DriveTest, ATargetIsTakenWithTheRisingEdgeOfNewSetPointAlone) {
  config.follows_targets = true;
  Cia402Drive sut = make();
  to_operational(sut);
  const auto write = [&](std::initializer_list<int> bytes) { sut.receive(frame(0x605, bytes), now); };
  write({0x2F, 0x60, 0x60, 0x00, 1, 0, 0, 0});        // profile position
  write({0x23, 0x81, 0x60, 0x00, 0xE8, 0x03, 0, 0});  // 1000 increments a second
  write({0x23, 0x7A, 0x60, 0x00, 0x64, 0, 0, 0});     // target 100
  for (const int word : {0x06, 0x07, 0x0F, 0x1F}) write({0x2B, 0x40, 0x60, 0x00, word, 0, 0, 0});
  write({0x23, 0x7A, 0x60, 0x00, 0x0A, 0, 0, 0});  // target 10, while bit 4 stays on
  write({0x2B, 0x40, 0x60, 0x00, 0x1F, 0, 0, 0});
  for (int i = 1; i <= 200; ++i) sut.advance(now + i * 1ms);
  EXPECT_EQ(sut.position(), 100) << "bit 4 was on already";
  write({0x2B, 0x40, 0x60, 0x00, 0x0F, 0, 0, 0});
  write({0x2B, 0x40, 0x60, 0x00, 0x1F, 0, 0, 0});
  for (int i = 201; i <= 400; ++i) sut.advance(now + i * 1ms);
  EXPECT_EQ(sut.position(), 10);
}

// CiA 301, 7.3.2.1: no EMCY in the state "stopped".
TEST_F(DriveTest, AStoppedNodeSendsNoEmcy) {
  Cia402Drive sut = make();
  to_operational(sut);
  sut.receive(frame(0x000, {0x02, 0x05}), now);
  sent.take();
  sut.raise_fault(0x8611, 0x21, now);
  EXPECT_TRUE(sent.take().empty());
  EXPECT_EQ(sut.state(), Cia402State::fault);
}

TEST_F(DriveTest, FaultIsToldAndReset) {
  Cia402Drive sut = make();
  to_operational(sut);
  sut.raise_fault(0x8611, 0x21, now);
  EXPECT_EQ(sent.take(), (Frames{frame(0x085, {0x11, 0x86, 0x21, 0, 0, 0, 0, 0})}));
  EXPECT_EQ(sut.state(), Cia402State::fault);
  EXPECT_EQ(sut.objects().integer({0x603F, 0}), 0x8611);
  sut.receive(frame(0x605, {0x2B, 0x40, 0x60, 0x00, 0x80, 0, 0, 0}), now);
  EXPECT_EQ(sut.state(), Cia402State::switch_on_disabled);
  EXPECT_EQ(sent.take()[0], frame(0x085, {0, 0, 0, 0, 0, 0, 0, 0})) << "error reset";
}

TEST_F(DriveTest, MappingChangesOnlyWhileThePdoIsOff) {
  Cia402Drive sut = make();
  sut.power_on(now);
  sent.take();
  const auto write = [&](std::initializer_list<int> bytes) {
    sut.receive(frame(0x605, bytes), now);
    return sent.take().back();
  };
  // 0x08000022: not possible in this state.
  EXPECT_EQ(write({0x2F, 0x00, 0x1A, 0x00, 0, 0, 0, 0}), frame(0x585, {0x80, 0x00, 0x1A, 0x00, 0x22, 0, 0, 0x08}));
  EXPECT_EQ(write({0x23, 0x00, 0x18, 0x01, 0x85, 0x01, 0, 0xC0}).data[0], 0x60);
  EXPECT_EQ(write({0x23, 0x00, 0x1A, 0x01, 0x20, 0, 0x64, 0x60}).data[0], 0x80) << "subindex 0 is not 0";
  EXPECT_EQ(write({0x2F, 0x00, 0x1A, 0x00, 0, 0, 0, 0}).data[0], 0x60);
  // 0x06040041: 0x1000 cannot be mapped.
  EXPECT_EQ(write({0x23, 0x00, 0x1A, 0x01, 0x20, 0, 0x00, 0x10}),
            frame(0x585, {0x80, 0x00, 0x1A, 0x01, 0x41, 0, 0x04, 0x06}));
  EXPECT_EQ(write({0x23, 0x00, 0x1A, 0x01, 0x20, 0, 0x64, 0x60}).data[0], 0x60);
  EXPECT_EQ(write({0x2F, 0x00, 0x1A, 0x00, 1, 0, 0, 0}).data[0], 0x60);
  EXPECT_EQ(write({0x23, 0x00, 0x18, 0x01, 0x85, 0x01, 0, 0x40}).data[0], 0x60);
  sut.receive(frame(0x000, {0x01, 0x05}), now);
  sut.receive(frame(0x080, {}), now);
  EXPECT_EQ(sent.take(), (Frames{frame(0x185, {0, 0, 0, 0})}));
}

TEST_F(DriveTest, SelfStartingDriveSendsWithoutAMaster) {
  config.self_starting = true;
  config.tpdos = {{.number = 1, .event_timer_ms = 10, .entries = {{0x6041, 0, 16}, {0x6064, 0, 32}}}};
  Cia402Drive sut = make();
  sut.power_on(now);
  const auto frames = sent.take();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(decode_statusword(static_cast<std::uint16_t>(frames[1].data[0] | frames[1].data[1] << 8)),
            Cia402State::operation_enabled);
}

TEST_F(DriveTest, KeepsItsPositionOverAReset) {
  Cia402Drive sut = make();
  to_operational(sut);
  sut.set_actual(1234, 0, 0, now);
  sut.power_off();
  sut.power_on(now);
  EXPECT_EQ(sut.position(), 1234);
}

}  // namespace
}  // namespace cellmirror::can
