// Channels that every machine has: logs and the virtual bus; UDP on the loopback interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "drivers/can/channel/endpoint.hpp"
#include "drivers/can/channel/error_frame.hpp"
#include "drivers/can/channel/log_format.hpp"
#include "drivers/can/channel/open_channel.hpp"
#include "drivers/can/channel/socket_channel.hpp"
#include "drivers/can/channel/virtual_bus.hpp"
#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Nanoseconds kLong = 5s;  // never waited out where the code works

// A channel whose interface was removed: its socket cannot be opened again.
struct ChannelWithoutInterface final : SocketChannel {
  Result<void> open_socket() override { return fail("there is no network interface gone0"); }
  bool fill() override { return true; }
  bool is_current() override { return true; }
  void send_all(std::span<const CanFrame> frames, std::span<bool> sent) override {
    std::vector<mmsghdr> messages(frames.size());
    std::vector<int> errors(frames.size());
    send_messages(socket_.get(), messages, errors);
    count_sent(errors, sent);
  }
  void refuse(int error) override { note_refused(error == ENOTCONN ? "send: not connected" : "send: ?"); }
};

TEST(SocketChannel, AFrameThatIsNotSentDoesNotHideWhyTheChannelIsDown) {
  ChannelWithoutInterface sut;
  EXPECT_FALSE(sut.send({}));
  EXPECT_EQ(sut.status().last_error, "send: not connected");
  ReceivedCanFrame got;
  EXPECT_EQ(sut.receive(got, 1ms), CanReceive::down);
  EXPECT_FALSE(sut.send({}));
  EXPECT_EQ(sut.status().last_error, "there is no network interface gone0");
  EXPECT_EQ(sut.status().send_refused, 2U);
}

TEST(Endpoint, NamesTheKinds) {
  EXPECT_EQ(std::get<SocketCanEndpoint>(*parse_endpoint("socketcan:can0")).interface, "can0");
  const auto v4 = std::get<UdpEndpoint>(*parse_endpoint("udp:239.74.163.2:43113"));
  EXPECT_EQ(v4.group, "239.74.163.2");
  EXPECT_EQ(v4.port, 43113);
  const auto v6 = std::get<UdpEndpoint>(*parse_endpoint("udp:[ff15:7079:7468:6f6e:6465:6d6f:6d63:6173]:43113"));
  EXPECT_TRUE(v6.ipv6);
  EXPECT_EQ(v6.group, "ff15:7079:7468:6f6e:6465:6d6f:6d63:6173");
  EXPECT_EQ(std::get<LogEndpoint>(*parse_endpoint("log:/tmp/a:b.log")).file, "/tmp/a:b.log");
}

TEST(Endpoint, RefusesOthersWithARemedy) {
  for (const char* text :
       {"", "can0", "socketcan:", "socketcan:a/b", "socketcan:a_name_that_is_too_long", "udp:1.2.3.4",
        "udp:192.168.0.1:43113", "udp:239.74.163.2:0", "udp:239.74.163.2:99999", "udp:[::1]:43113", "log:"}) {
    const auto sut = parse_endpoint(text);
    ASSERT_FALSE(sut) << text;
    EXPECT_FALSE(sut.error().remedy.empty()) << text;
  }
}

TEST(ErrorFrame, TellsTheStateOfTheBus) {
  CanFrame sut = frame(CAN_ERR_BUSOFF, {0, 0, 0, 0, 0, 0, 0, 0});
  sut.error = true;
  EXPECT_EQ(bus_state_of_error(sut), CanBusState::bus_off);
  EXPECT_EQ(error_words(sut), "bus-off");
  sut.id = CAN_ERR_CRTL;
  sut.data[1] = CAN_ERR_CRTL_TX_PASSIVE;
  EXPECT_EQ(bus_state_of_error(sut), CanBusState::passive);
  sut.data[1] = CAN_ERR_CRTL_RX_WARNING;
  EXPECT_EQ(bus_state_of_error(sut), CanBusState::warning);
  EXPECT_EQ(error_words(sut), "controller, receive warning");
  sut.id = CAN_ERR_RESTARTED;
  EXPECT_EQ(bus_state_of_error(sut), CanBusState::active);
  sut.id = CAN_ERR_ACK;
  EXPECT_FALSE(bus_state_of_error(sut));
}

struct LogTest : testing::Test {
  LogTest() { path = testing::TempDir() + "can_log_test_" + std::to_string(getpid()) + ".log"; }
  ~LogTest() override { std::filesystem::remove(path); }
  std::unique_ptr<CanChannel> open(const std::string& text, bool fast = true, bool repeat = false) {
    std::ofstream(path, std::ios::binary) << text;
    CanChannelConfig config;
    config.endpoint = "log:" + path;
    config.log_as_fast_as_possible = fast;
    config.log_repeat = repeat;
    auto channel = open_can_channel(config);
    EXPECT_TRUE(channel);
    return channel ? std::move(*channel) : nullptr;
  }
  std::string path;
  ReceivedCanFrame got;
};

TEST_F(LogTest, PlaysItsFramesAndEnds) {
  const auto sut = open("(1.000000) vcan0 123#11\n(1000.000000) vcan0 124#22");
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(got.frame, frame(0x123, {0x11}));
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(got.frame, frame(0x124, {0x22}));
  EXPECT_EQ(sut->receive(got, 1ms), CanReceive::end);
  EXPECT_EQ(sut->status().received, 2U);
  EXPECT_FALSE(sut->send(frame(1, {})));
  EXPECT_EQ(sut->status().send_refused, 1U);
}

TEST_F(LogTest, KeepsTheTimeBetweenItsFrames) {
  const auto sut = open("(1.000) vcan0 123#\n(1.040) vcan0 124#\n(0.5) vcan0 125#\n", false);
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame);
  const Timestamp first = got.receive_time;
  EXPECT_EQ(sut->receive(got, 1ms), CanReceive::timeout);
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame);
  EXPECT_GE(got.receive_time - first, 40ms);
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame) << "a stamp that goes back is due at once";
}

TEST_F(LogTest, BrokenLinesAreCountedWithTheirPlace) {
  const auto sut = open("\n(1.0) vcan0 123#\nnonsense\n(1.0) vcan0 " + std::string(2000, 'x') + "\n(1.0) vcan0 124#\n");
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(got.frame.id, 0x124U);
  EXPECT_EQ(sut->status().malformed, 2U);
  EXPECT_EQ(sut->status().last_error, path + ":4: the line is too long or holds a NUL byte");
}

TEST_F(LogTest, BusOffEndsWithTheFirstFrame) {
  const auto sut = open("(1.0) vcan0 20000040#0000000000000000\n(1.0) vcan0 123#\n");
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame);
  EXPECT_TRUE(got.frame.error);
  EXPECT_EQ(sut->status().bus, CanBusState::bus_off);
  EXPECT_EQ(sut->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(sut->status().bus, CanBusState::active);
}

TEST_F(LogTest, RepeatsFromTheStart) {
  const auto sut = open("(1.0) vcan0 123#\n(1.0) vcan0 124#\n", true, true);
  for (int i = 0; i < 10; ++i) {
    const bool begins_again = i > 0 && i % 2 == 0;
    if (begins_again) {
      EXPECT_EQ(sut->receive(got, kLong), CanReceive::again);
    }
    ASSERT_EQ(sut->receive(got, kLong), CanReceive::frame);
    EXPECT_EQ(got.frame.id, i % 2 == 0 ? 0x123U : 0x124U);
  }
}

TEST_F(LogTest, RepeatingALogWithoutFramesEnds) {
  const auto sut = open("\n\n", true, true);
  CanReceive result = CanReceive::timeout;
  for (int i = 0; i < 10 && result != CanReceive::end; ++i) result = sut->receive(got, 1ms);
  EXPECT_EQ(result, CanReceive::end);
}

TEST(LogFormat, NamesOtherFormatsAndTheirConverter) {
  using namespace std::string_view_literals;
  const std::pair<std::string_view, const char*> cases[] = {
      {"date Wed Apr 14 10:00:00.000 2021\nbase hex  timestamps absolute\n", "asc2log"},
      {"   0.015991 1  100x            Rx   d 8 11 22 33 44 55 66 77 88\n", "asc2log"},
      {"LOGG\x90\0\0\0\x05"sv, "can_logconvert"},
      {";$FILEVERSION=1.1\n;$STARTTIME=43000.1\n", "can_logconvert"},
      {"timestamp,arbitration_id,extended,remote,error,dlc,data\n0.0,0x1,0,0,0,1,EQ==\n", "can_logconvert"},
      {"\x1F\x8B\x08\0\0"sv, "gunzip"},
      {"  vcan0  123   [8]  11 22 33 44 55 66 77 88\n", "candump -L"},
      {" (1436509052.249713)  vcan0  123   [2]  11 22\n", "candump -L"},
      {" (1436509052.249713)  vcan0  RX - -  123   [2]  11 22\n", "candump -L"},
      {"nonsense\n", "candump -l"},
  };
  for (const auto& [text, remedy] : cases) {
    const auto checked = check_log_beginning(text, true);
    ASSERT_FALSE(checked) << text;
    EXPECT_THAT(checked.error().remedy, HasSubstr(remedy)) << text;
  }
}

TEST(LogFormat, AcceptsBrokenLinesAndEmptyFiles) {
  EXPECT_TRUE(check_log_beginning("", true));
  EXPECT_TRUE(check_log_beginning("\n\n", true));
  EXPECT_TRUE(check_log_beginning("nonsense\n(1.0) vcan0 123#\n", true));
  EXPECT_TRUE(check_log_beginning("(1.0) vcan0 123#11\n(1.0) vcan0 12", false)) << "cut within a line";
  EXPECT_FALSE(check_log_beginning(std::string(kLogBeginning, 'x'), false));
}

TEST(LogChannel, OpeningAndCheckingRefuseAnotherFormatWithTheFileName) {
  const std::string path = testing::TempDir() + "can_foreign_" + std::to_string(getpid()) + ".asc";
  std::ofstream(path) << "date Wed Apr 14 10:00:00.000 2021\nbase hex  timestamps absolute\n";
  CanChannelConfig config;
  config.endpoint = "log:" + path;
  const auto sut = open_can_channel(config);
  ASSERT_FALSE(sut);
  EXPECT_EQ(sut.error().what, path + ": the file is a log of Vector's tools (ASC)");
  Diagnostics diagnostics;
  check_channel(config, {"cell.toml", 3, 1}, diagnostics);
  EXPECT_THAT(diagnostics.text(), HasSubstr("cell.toml:3:1: error: " + path + ": the file is a log of Vector's"));
  std::filesystem::remove(path);
}

TEST(ErrorFrame, ShowsErrorCountersAndUnknownClasses) {
  CanFrame sut = frame(0x200, {0, 0, 0, 0, 0, 0, 96, 127});
  sut.error = true;
  EXPECT_EQ(error_words(sut), "error counters 96 (transmit) and 127 (receive)");
  sut.id = 0x1000;
  EXPECT_EQ(error_words(sut), "error of the unknown class 0x1000");
}

TEST(LogChannel, MissingFilesAndFoldersAreRefused) {
  CanChannelConfig config;
  config.endpoint = "log:/does/not/exist";
  EXPECT_FALSE(open_can_channel(config));
  config.endpoint = "log:/";
  EXPECT_THAT(open_can_channel(config).error().what, HasSubstr("no regular file"));
}

TEST(SocketCanChannel, WithoutCanOrInterfaceItFailsWithARemedy) {
  CanChannelConfig config;
  config.endpoint = "socketcan:nosuchcan9";
  const auto sut = open_can_channel(config);
  ASSERT_FALSE(sut);
  EXPECT_FALSE(sut.error().remedy.empty());
  EXPECT_THAT(sut.error().text(), testing::Not(HasSubstr("link add")))
      << "a real interface must not be created by hand";
}

TEST(SocketCanChannel, WaitsForAnInterfaceThatIsMissing) {
  CanChannelConfig config;
  config.endpoint = "socketcan:nosuchcan9";
  const auto sut = open_can_channel(config, WhereMissing::wait);
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ((*sut)->status().waits_for, "nosuchcan9");
  EXPECT_EQ((*sut)->status().bus, CanBusState::down);
  EXPECT_THAT((*sut)->status().last_error, testing::StartsWith("waits for nosuchcan9: "));
  ReceivedCanFrame got;
  EXPECT_EQ((*sut)->receive(got, 1ms), CanReceive::down);
  EXPECT_FALSE((*sut)->send(frame(1, {})));
}

// A channel whose interface appears while it waits.
struct LateChannel final : SocketChannel {
  Result<void> open_socket() override {
    status_.waits_for = "late0";
    if (!there) return fail("there is no network interface late0");
    status_.waits_for.clear();
    socket_ = Descriptor(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    return {};
  }
  bool fill() override { return true; }
  bool is_current() override { return true; }
  void send_all(std::span<const CanFrame> /*frames*/, std::span<bool> /*sent*/) override {}
  void refuse(int /*error*/) override {}
  bool there = false;
};

TEST(SocketChannel, OpensWhenTheMissingInterfaceAppears) {
  LateChannel sut;
  ASSERT_TRUE(sut.open_or_wait());
  ReceivedCanFrame got;
  EXPECT_EQ(sut.receive(got, 1ms), CanReceive::down);
  EXPECT_EQ(sut.status().waits_for, "late0");
  sut.there = true;
  for (int i = 0; i < 1000 && !sut.status().waits_for.empty(); ++i) static_cast<void>(sut.receive(got, 10ms));
  EXPECT_EQ(sut.status().waits_for, "");
  EXPECT_EQ(sut.status().reopened, 1U);
}

struct VirtualBusTest : testing::Test {
  VirtualCanBus sut;
  std::unique_ptr<CanChannel> a = sut.connect();
  std::unique_ptr<CanChannel> b = sut.connect();
  ReceivedCanFrame got;
};

TEST_F(VirtualBusTest, DeliversToTheOthers) {
  EXPECT_TRUE(a->send(frame(0x123, {1})));
  EXPECT_EQ(b->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(got.frame, frame(0x123, {1}));
  EXPECT_EQ(a->receive(got, 0ns), CanReceive::timeout);
}

TEST_F(VirtualBusTest, BusOffRefusesAndIsToldByAnErrorFrame) {
  sut.set_state(CanBusState::bus_off);
  EXPECT_FALSE(a->send(frame(1, {})));
  EXPECT_EQ(a->status().bus, CanBusState::bus_off);
  EXPECT_EQ(a->receive(got, kLong), CanReceive::frame);
  EXPECT_TRUE(got.frame.error);
  EXPECT_EQ(a->status().error_frames, 1U);
  sut.set_state(CanBusState::active);
  EXPECT_TRUE(a->send(frame(1, {})));
}

TEST_F(VirtualBusTest, DownIsTold) {
  sut.set_state(CanBusState::down);
  EXPECT_EQ(a->receive(got, 0ns), CanReceive::down);
  EXPECT_FALSE(a->send(frame(1, {})));
}

TEST_F(VirtualBusTest, FilterLosesAndRepeats) {
  sut.set_filter([](const CanFrame& f) -> std::vector<CanFrame> {
    if (f.id == 1) return {};
    return {f, f};
  });
  a->send(frame(1, {}));
  a->send(frame(2, {}));
  EXPECT_EQ(b->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(got.frame.id, 2U);
  EXPECT_EQ(b->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(b->receive(got, 0ns), CanReceive::timeout);
}

TEST_F(VirtualBusTest, DelayHoldsFramesBack) {
  sut.set_delay(20ms);
  const Timestamp sent = SystemClock().now();
  a->send(frame(1, {}));
  EXPECT_EQ(b->receive(got, 0ns), CanReceive::timeout);
  EXPECT_EQ(b->receive(got, kLong), CanReceive::frame);
  EXPECT_GE(got.receive_time - sent, 20ms);
}

TEST_F(VirtualBusTest, FullQueuesDropTheOldestAndCountIt) {
  VirtualCanBus small(2);
  const auto x = small.connect();
  const auto y = small.connect();
  for (std::uint32_t i = 0; i < 5; ++i) x->send(frame(i, {}));
  EXPECT_EQ(y->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(got.frame.id, 3U);
  EXPECT_EQ(y->status().receive_dropped, 3U);
}

TEST_F(VirtualBusTest, RefusedSendsAreCounted) {
  sut.refuse_sends(1);
  EXPECT_FALSE(a->send(frame(1, {})));
  EXPECT_TRUE(a->send(frame(1, {})));
  EXPECT_EQ(a->status().send_refused, 1U);
}

// A group and a port of this process alone, so that test runs beside each other do not hear each other.
std::string own_group() {
  const int pid = getpid();
  return "udp:239.74." + std::to_string(pid >> 8 & 0xFF) + "." + std::to_string(pid & 0xFF) + ":" +
         std::to_string(20000 + pid % 20000);
}

TEST(UdpChannel, MembersHearEachOtherButNotThemselves) {
  CanChannelConfig config;
  config.endpoint = own_group();
  auto a = open_can_channel(config);
  auto b = open_can_channel(config);
  if (!a || !b) GTEST_SKIP() << "skipped: no multicast on the loopback interface: " << a.error().text();
  CanFrame sent = extended_frame(0x1ABCDEF0, {1, 2, 3});
  sent.fd = true;
  sent.bit_rate_switch = true;
  ASSERT_TRUE((*a)->send(sent));
  ReceivedCanFrame got;
  ASSERT_EQ((*b)->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(got.frame, sent);
  EXPECT_LT(SystemClock().now() - got.receive_time, 2s);
  EXPECT_GE(SystemClock().now() - got.receive_time, 0s);
  ASSERT_TRUE((*b)->send(frame(7, {})));
  ASSERT_EQ((*a)->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ(got.frame.id, 7U) << "the first that a hears is b's";
  EXPECT_EQ((*a)->status().sent, 1U);
  EXPECT_EQ((*a)->status().received, 1U);
  EXPECT_EQ((*a)->status().bus, CanBusState::active);
}

TEST(UdpChannel, SeveralFramesAreSentInTheirOrderWhateverTheirSizes) {
  CanChannelConfig config;
  config.endpoint = own_group();
  auto sender = open_can_channel(config);
  auto listener = open_can_channel(config);
  if (!sender || !listener) GTEST_SKIP() << "skipped: no multicast on the loopback interface";
  Frames frames;
  for (int i = 0; i < 150; ++i) frames.push_back(i % 40 < 30 ? frame(0x281, {i, 0, 0, 0}) : frame(0x281, {i, i % 7}));
  std::array<bool, 150> sent{};
  (*sender)->send_all(frames, sent);
  EXPECT_TRUE(std::ranges::all_of(sent, [](bool each) { return each; }));
  EXPECT_EQ((*sender)->status().sent, frames.size());
  for (const CanFrame& expected : frames) {
    ReceivedCanFrame got;
    ASSERT_EQ((*listener)->receive(got, kLong), CanReceive::frame);
    EXPECT_EQ(got.frame, expected);
  }
  ReceivedCanFrame own;
  EXPECT_EQ((*sender)->receive(own, 1ms), CanReceive::timeout);
}

TEST(UdpChannel, BusOffEndsWithTheFirstFrame) {
  CanChannelConfig config;
  config.endpoint = own_group();
  auto sender = open_can_channel(config);
  auto sut = open_can_channel(config);
  if (!sender || !sut) GTEST_SKIP() << "skipped: no multicast on the loopback interface: " << sender.error().text();
  CanFrame bus_off = frame(CAN_ERR_BUSOFF, {0, 0, 0, 0, 0, 0, 0, 0});
  bus_off.error = true;
  ReceivedCanFrame got;
  ASSERT_TRUE((*sender)->send(bus_off));
  ASSERT_EQ((*sut)->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ((*sut)->status().bus, CanBusState::bus_off);
  ASSERT_TRUE((*sender)->send(frame(7, {})));
  ASSERT_EQ((*sut)->receive(got, kLong), CanReceive::frame);
  EXPECT_EQ((*sut)->status().bus, CanBusState::active);
}

TEST(UdpChannel, UnknownInterfaceIsRefused) {
  CanChannelConfig config;
  config.endpoint = own_group();
  config.interface = "nosuchif9";
  EXPECT_THAT(open_can_channel(config).error().what, HasSubstr("nosuchif9"));
  const auto waiting = open_can_channel(config, WhereMissing::wait);
  ASSERT_TRUE(waiting);
  EXPECT_EQ((*waiting)->status().waits_for, "nosuchif9");
}

}  // namespace
}  // namespace cellmirror::can
