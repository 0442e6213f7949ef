// allow_from of a udp channel: datagrams of other senders are refused and counted. On the loopback interface, whose
// addresses 127.0.0.1 and 127.0.0.2 are the member and the stranger.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "drivers/can/channel/open_channel.hpp"
#include "drivers/can/channel/udp_datagram.hpp"
#include "rt_core/base/descriptor.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr const char* kGroup = "239.74.163.97";

std::uint16_t port() { return static_cast<std::uint16_t>(30'000 + getpid() % 20'000); }

std::unique_ptr<CanChannel> channel_for(const std::vector<std::string>& allow_from) {
  CanChannelConfig config;
  config.endpoint = "udp:" + std::string(kGroup) + ":" + std::to_string(port());
  config.allow_from = allow_from;
  auto made = open_can_channel(config);
  EXPECT_TRUE(made) << made.error().text();
  return made ? std::move(*made) : nullptr;
}

// A frame with that identifier, from that address of the loopback interface.
void send_from(const std::string& source, std::uint32_t id) {
  const Descriptor sender(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in own{};
  own.sin_family = AF_INET;
  inet_pton(AF_INET, source.c_str(), &own.sin_addr);
  ASSERT_EQ(bind(sender.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own), 0);
  ip_mreqn by{};
  by.imr_ifindex = static_cast<int>(if_nametoindex("lo"));
  setsockopt(sender.get(), IPPROTO_IP, IP_MULTICAST_IF, &by, sizeof by);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port());
  inet_pton(AF_INET, kGroup, &to.sin_addr);
  CanFrame frame;
  frame.id = id;
  const UdpDatagram datagram = encode_udp_datagram(frame, 0.0);
  ASSERT_EQ(
      sendto(sender.get(), datagram.bytes.data(), datagram.size, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
      static_cast<ssize_t>(datagram.size));
}

std::uint32_t next_id(CanChannel& channel) {
  ReceivedCanFrame got;
  return channel.receive(got, 60s) == CanReceive::frame ? got.frame.id : 0;
}

TEST(UdpSources, TakesAllWithoutAList) {
  const auto sut = channel_for({});
  ASSERT_TRUE(sut);
  send_from("127.0.0.2", 0x102);
  send_from("127.0.0.1", 0x101);
  EXPECT_EQ(next_id(*sut), 0x102U);
  EXPECT_EQ(next_id(*sut), 0x101U);
  EXPECT_EQ(sut->status().foreign, 0U);
}

TEST(UdpSources, TakesThoseOfTheListAlone) {
  const auto sut = channel_for({"10.1.2.3", "127.0.0.1", "fe80::1"});
  ASSERT_TRUE(sut);
  for (int i = 0; i < 3; ++i) send_from("127.0.0.2", 0x102);
  send_from("127.0.0.1", 0x101);
  EXPECT_EQ(next_id(*sut), 0x101U) << "what came before was a stranger's";
  EXPECT_EQ(sut->status().foreign, 3U);
  EXPECT_EQ(sut->status().received, 1U);
  EXPECT_EQ(sut->status().malformed, 0U);
  EXPECT_THAT(sut->status().last_error, testing::HasSubstr("datagram from 127.0.0.2 refused"));
}

TEST(UdpSources, ComparesTheWholeAddress) {
  const auto sut = channel_for({"127.0.0.2", "0.0.0.1"});
  ASSERT_TRUE(sut);
  send_from("127.0.0.1", 0x101);
  send_from("127.0.0.2", 0x102);
  EXPECT_EQ(next_id(*sut), 0x102U);
}

TEST(UdpSources, RefusesATextThatIsNoAddress) {
  CanChannelConfig config;
  config.endpoint = "udp:" + std::string(kGroup) + ":" + std::to_string(port());
  config.allow_from = {"robot.example"};
  const auto sut = open_can_channel(config);
  ASSERT_FALSE(sut);
  EXPECT_THAT(sut.error().what, testing::HasSubstr("robot.example is no numeric address"));
}

}  // namespace
}  // namespace cellmirror::can
