// The udp channel in an IPv6 group, on the interface that with_veth.sh makes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>

#include "drivers/can/channel/open_channel.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

TEST(UdpIpv6, MembersHearEachOtherButNotThemselves) {
  const char* interface = std::getenv("CELLMIRROR_TEST_IPV6_INTERFACE");
  if (interface == nullptr) GTEST_SKIP() << "skipped: run it by tests/integration/can/with_veth.sh";
  CanChannelConfig config;
  config.endpoint = "udp:[ff15:7079:7468:6f6e:6465:6d6f:6d63:6173]:43113";  // python-can's default group
  config.interface = interface;
  auto a = open_can_channel(config);
  auto b = open_can_channel(config);
  ASSERT_TRUE(a) << a.error().text();
  ASSERT_TRUE(b) << b.error().text();
  CanFrame sent;
  sent.id = 0x123;
  sent.length = 3;
  sent.data = {1, 2, 3};
  ASSERT_TRUE((*a)->send(sent));
  ReceivedCanFrame got;
  ASSERT_EQ((*b)->receive(got, 60s), CanReceive::frame);
  EXPECT_EQ(got.frame.id, 0x123U);
  EXPECT_EQ(got.frame.data[2], 3);
  EXPECT_EQ((*a)->receive(got, 50ms), CanReceive::timeout);
}

TEST(UdpIpv6, LoopbackIsRefusedWithARemedy) {
  CanChannelConfig config;
  config.endpoint = "udp:[ff15:7079:7468:6f6e:6465:6d6f:6d63:6173]:43113";
  const auto sut = open_can_channel(config);
  if (sut) GTEST_SKIP() << "skipped: this machine's loopback interface takes IPv6 multicast";
  EXPECT_FALSE(sut.error().remedy.empty());
}

// The last one: the interface is gone afterwards.
TEST(UdpRemovedInterface, WhatIsSentMeanwhileDoesNotHideIt) {
  const char* interface = std::getenv("CELLMIRROR_TEST_IPV6_INTERFACE");
  if (interface == nullptr) GTEST_SKIP() << "skipped: run it by tests/integration/can/with_veth.sh";
  CanChannelConfig config;
  config.endpoint = "udp:[ff15:7079:7468:6f6e:6465:6d6f:6d63:6173]:43113";
  config.interface = interface;
  const auto sut = open_can_channel(config);
  ASSERT_TRUE(sut) << sut.error().text();
  ASSERT_EQ(std::system(("ip link del " + config.interface).c_str()), 0);
  CanFrame sent;
  sent.id = 0x123;
  ReceivedCanFrame got;
  for (int i = 0; i < 12'000 && (*sut)->status().bus != CanBusState::down; ++i) (*sut)->receive(got, 5ms);
  ASSERT_EQ((*sut)->status().bus, CanBusState::down);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE((*sut)->send(sent));
    EXPECT_THAT((*sut)->status().last_error, testing::HasSubstr("interface " + config.interface));
    (*sut)->receive(got, 10ms);
  }
}

}  // namespace
}  // namespace cellmirror::can
