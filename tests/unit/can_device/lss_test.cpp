// Layer setting services of a slave: chosen by identity or all at once, another node number, what is inquired; nodes
// that have no number, and how a master finds them. Frames by hand, after CiA 305.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <utility>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/lss.hpp"
#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

CanFrame lss(int command, std::uint32_t value = 0) {
  CanFrame request = frame(0x7E5, {command, 0, 0, 0, 0, 0, 0, 0});
  put_le(std::span(request.data).subspan(1), value, 4);
  return request;
}

CanFrame scan(std::uint32_t number, int bit, int part, int next) {
  CanFrame request = lss(0x51, number);
  request.data[5] = static_cast<std::uint8_t>(bit);
  request.data[6] = static_cast<std::uint8_t>(part);
  request.data[7] = static_cast<std::uint8_t>(next);
  return request;
}

DriveConfig unnumbered() {
  DriveConfig config = test_drive();
  config.waits_for_lss = true;
  return config;
}

struct Lss : testing::Test {
  explicit Lss(const DriveConfig& config = test_drive()) : master(config) {}

  // The answer's bytes 0 to 4 as command and value; nothing where there is none.
  std::optional<std::pair<int, std::uint32_t>> ask(int command, std::uint32_t value = 0) {
    return answer(lss(command, value));
  }
  std::optional<std::pair<int, std::uint32_t>> answer(const CanFrame& request) {
    master.take();
    master.receive(request);
    for (const CanFrame& sent : master.frames) {
      if (sent.id == 0x7E4) return std::pair(int{sent.data[0]}, get_le32(std::span(sent.data).subspan(1)));
    }
    return {};
  }
  void choose() {
    for (const int command : {0x40, 0x41, 0x42}) EXPECT_FALSE(ask(command, 0));
    EXPECT_EQ(ask(0x43, 5), (std::pair(0x44, 0U)));
  }
  bool boots(std::uint32_t node, int nmt) {
    master.take();
    master.receive(frame(0x000, {nmt, 0}));
    for (const CanFrame& sent : master.frames) {
      if (sent.id == 0x700 + node && sent.data[0] == 0) return true;
    }
    return false;
  }

  DriveMaster master;  // node 5, whose serial number is 5
};

TEST_F(Lss, WhoIsNotChosenDoesNotAnswer) {
  EXPECT_FALSE(ask(0x5E));
  EXPECT_FALSE(ask(0x11, 9));
  EXPECT_TRUE(boots(5, 0x82));
}

TEST_F(Lss, ChosenByIdentity) {
  choose();
  EXPECT_EQ(ask(0x5A), (std::pair(0x5A, 0U)));
  EXPECT_EQ(ask(0x5D), (std::pair(0x5D, 5U)));
  EXPECT_EQ(ask(0x5E), (std::pair(0x5E, 5U)));
  EXPECT_FALSE(ask(0x04, 0)) << "waiting again";
  EXPECT_FALSE(ask(0x5E));
}

TEST_F(Lss, AnotherIdentityIsNotChosen) {
  for (const int command : {0x40, 0x41, 0x42}) EXPECT_FALSE(ask(command, 0));
  EXPECT_FALSE(ask(0x43, 6));
  EXPECT_FALSE(ask(0x5E));
  EXPECT_FALSE(ask(0x43, 5)) << "the whole identity, in its order";
  EXPECT_FALSE(ask(0x5E));
}

TEST_F(Lss, AnotherNodeNumberAfterResetCommunication) {
  EXPECT_FALSE(ask(0x04, 1));
  EXPECT_EQ(ask(0x11, 9), (std::pair(0x11, 0U)));
  EXPECT_EQ(ask(0x5E), (std::pair(0x5E, 5U))) << "not before";
  EXPECT_TRUE(boots(9, 0x82));
  EXPECT_EQ(master.drive.node_id(), 9);
  EXPECT_EQ(master.object(0x1400, 1), 0x209);
  EXPECT_EQ(master.object(0x1801, 1), 0x289);
  EXPECT_EQ(master.object(0x1014), 0x89);
  EXPECT_EQ(master.object(0x1018, 4), 5) << "the serial number stays";
  master.take();
  master.receive(frame(0x609, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));
  ASSERT_EQ(master.frames.size(), 1U);
  EXPECT_EQ(master.frames[0].id, 0x589U);
  master.take();
  master.receive(frame(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));
  EXPECT_TRUE(master.frames.empty());
  EXPECT_TRUE(boots(5, 0x81)) << "reset node: what the cell file says";
  EXPECT_EQ(master.object(0x1400, 1), 0x205);
}

TEST_F(Lss, WhatIsNotSupported) {
  EXPECT_FALSE(ask(0x04, 1));
  EXPECT_EQ(ask(0x11, 0), (std::pair(0x11, 1U)));
  EXPECT_EQ(ask(0x11, 128), (std::pair(0x11, 1U)));
  EXPECT_EQ(ask(0x13, 0), (std::pair(0x13, 1U))) << "bit timing";
  EXPECT_EQ(ask(0x17), (std::pair(0x17, 1U))) << "storing";
  EXPECT_FALSE(ask(0x15, 100));
}

// The bounds of the identity in their order: vendor, product, revision from and to, serial number from and to.
TEST_F(Lss, IdentifiesItselfWithinTheBounds) {
  const auto identify = [this](std::array<std::uint32_t, 6> bounds) {
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(ask(0x46 + i, bounds.at(static_cast<std::size_t>(i))));
    return ask(0x4B, bounds[5]);
  };
  const std::pair identified(0x4F, 0U);
  EXPECT_EQ(identify({0, 0, 0, 0, 5, 5}), identified);
  EXPECT_EQ(identify({0, 0, 0, 0xFFFFFFFF, 0, 0xFFFFFFFF}), identified);
  EXPECT_FALSE(identify({1, 0, 0, 0, 5, 5}));
  EXPECT_FALSE(identify({0, 0, 1, 2, 5, 5}));
  EXPECT_FALSE(identify({0, 0, 0, 0, 6, 9}));
  EXPECT_FALSE(identify({0, 0, 0, 0, 0, 4}));
  EXPECT_FALSE(ask(0x4B, 5)) << "the last bound alone";
  EXPECT_FALSE(ask(0x04, 1));
  EXPECT_EQ(identify({0, 0, 0, 0, 5, 5}), identified) << "chosen, too";
}

TEST_F(Lss, WhoHasANumberIsNotScanned) {
  EXPECT_FALSE(ask(0x4C));
  EXPECT_FALSE(answer(scan(0, 0x80, 0, 0)));
}

struct UnnumberedLss : Lss {
  UnnumberedLss() : Lss(unnumbered()) {}

  // What a master does: each bit from the highest, 0 where there is an answer; then the whole number.
  std::optional<std::uint32_t> find(int part, int next) {
    std::uint32_t number = 0;
    for (int bit = 31; bit >= 0; --bit) {
      if (!answer(scan(number, bit, part, part))) number |= 1U << bit;
    }
    return answer(scan(number, 0, part, next)) ? std::optional(number) : std::nullopt;
  }
};

TEST_F(UnnumberedLss, SaysNothingUntilItHasANumber) {
  EXPECT_TRUE(master.frames.empty()) << "no boot-up message";
  EXPECT_FALSE(boots(5, 0x81));
  master.receive(frame(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));
  master.receive(frame(0x000, {0x01, 0}));
  master.run(100ms);
  EXPECT_TRUE(master.frames.empty());
  EXPECT_EQ(master.drive.nmt_state(), NmtState::boot_up);
  EXPECT_EQ(ask(0x4C), (std::pair(0x50, 0U)));
}

TEST_F(UnnumberedLss, FoundByFastscan) {
  EXPECT_EQ(answer(scan(0, 0x80, 0, 0)), (std::pair(0x4F, 0U)));
  EXPECT_EQ(find(0, 1), 0U);
  EXPECT_EQ(find(1, 2), 0U);
  EXPECT_EQ(find(2, 3), 0U);
  EXPECT_FALSE(ask(0x5E)) << "not chosen yet";
  EXPECT_EQ(find(3, 0), 5U);
  EXPECT_EQ(ask(0x5E), (std::pair(0x5E, 255U))) << "chosen";
  EXPECT_FALSE(answer(scan(0, 0x80, 0, 0))) << "who is chosen is not scanned";

  EXPECT_EQ(ask(0x11, 33), (std::pair(0x11, 0U)));
  EXPECT_FALSE(ask(0x04, 0));
  ASSERT_EQ(master.frames.size(), 1U) << "it boots by itself";
  EXPECT_EQ(master.frames[0].id, 0x721U);
  EXPECT_EQ(master.drive.node_id(), 33);
  EXPECT_EQ(master.object(0x1400, 1), 0x221);
  EXPECT_FALSE(ask(0x4C));
  EXPECT_FALSE(boots(33, 0x81)) << "reset node: without a number again";
  EXPECT_EQ(ask(0x4C), (std::pair(0x50, 0U)));
}

TEST_F(UnnumberedLss, ScansThatAreWrongAreNotAnswered) {
  EXPECT_EQ(answer(scan(0, 0x80, 0, 0)), (std::pair(0x4F, 0U)));
  EXPECT_FALSE(answer(scan(0, 32, 0, 0)));
  EXPECT_FALSE(answer(scan(0, 31, 4, 0)));
  EXPECT_FALSE(answer(scan(0, 31, 0, 4)));
  EXPECT_FALSE(answer(scan(0, 31, 1, 1))) << "the scan is at the vendor";
  EXPECT_FALSE(answer(scan(0x80000000, 31, 0, 0)));
  EXPECT_TRUE(answer(scan(0x7FFFFFFF, 31, 0, 0))) << "the lower bits do not count";
}

TEST_F(UnnumberedLss, TheNumberMayBeTakenAway) {
  EXPECT_FALSE(ask(0x04, 1));
  EXPECT_EQ(ask(0x11, 7), (std::pair(0x11, 0U)));
  EXPECT_FALSE(ask(0x04, 0));
  EXPECT_EQ(master.drive.node_id(), 7);
  EXPECT_FALSE(ask(0x04, 1));
  EXPECT_EQ(ask(0x11, 255), (std::pair(0x11, 0U)));
  EXPECT_FALSE(ask(0x04, 0));
  EXPECT_EQ(master.drive.node_id(), 7) << "until the communication is reset";
  EXPECT_FALSE(boots(7, 0x82));
  EXPECT_EQ(ask(0x4C), (std::pair(0x50, 0U)));
}

}  // namespace
}  // namespace cellmirror::can
