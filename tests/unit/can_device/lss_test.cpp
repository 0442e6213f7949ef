// Layer setting services of a slave: chosen by identity or all at once, another node number, what is inquired.
#include <gtest/gtest.h>

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

struct Lss : testing::Test {
  // The answer's bytes 0 to 4 as command and value; nothing where there is none.
  std::optional<std::pair<int, std::uint32_t>> ask(int command, std::uint32_t value = 0) {
    master.take();
    master.receive(lss(command, value));
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

}  // namespace
}  // namespace cellmirror::can
