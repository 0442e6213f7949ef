// The socketcan channel and a CiA 402 stream on a real kernel's vcan0, with can-utils as independent peers. Runs under
// tests/support/run-in-vcan.sh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <net/if.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>

#include "drivers/can/channel/open_channel.hpp"
#include "drivers/can/cia402/drive.hpp"
#include "drivers/can/stream/streams.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr const char* kDown = "the interface vcan0 is down: 'ip link set vcan0 up'";

int shell(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

// A program in the background, ended with its owner.
class Background {
 public:
  explicit Background(const std::string& command) : pid_(fork()) {
    if (pid_ == 0) {
      execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
      _exit(127);
    }
  }
  ~Background() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  bool has_ended() {
    if (pid_ <= 0) return true;
    if (waitpid(pid_, nullptr, WNOHANG) != pid_) return false;
    pid_ = -1;
    return true;
  }

 private:
  pid_t pid_;
};

template <class Condition>
bool becomes_true(Condition condition) {
  for (int i = 0; i < 12'000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(5ms);
  }
  return false;
}

CanFrame data_frame(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame frame;
  frame.id = id;
  for (const int byte : bytes) frame.data[frame.length++] = static_cast<std::uint8_t>(byte);
  return frame;
}

struct VcanTest : testing::Test {
  void SetUp() override {
    if (if_nametoindex("vcan0") == 0) GTEST_SKIP() << "skipped: no vcan0 here; run it by tests/support/run-in-vcan.sh";
    if (shell("command -v cansend >/dev/null") != 0)
      GTEST_SKIP() << "skipped: no can-utils (apt-get install can-utils)";
    CanChannelConfig config;
    config.endpoint = "socketcan:vcan0";
    auto channel = open_can_channel(config);
    ASSERT_TRUE(channel) << channel.error().text();
    sut = std::move(*channel);
  }
  bool receives() { return sut->receive(got, 5s) == CanReceive::frame; }

  std::string folder = testing::TempDir();
  std::unique_ptr<CanChannel> sut;
  ReceivedCanFrame got;
};

TEST_F(VcanTest, HearsCansend) {
  EXPECT_EQ(sut->status().bus, CanBusState::active);
  ASSERT_EQ(shell("cansend vcan0 123#1122334455"), 0);
  ASSERT_TRUE(receives());
  EXPECT_EQ(got.frame.id, 0x123U);
  EXPECT_EQ(got.frame.length, 5);
  EXPECT_EQ(got.frame.data[4], 0x55);
  EXPECT_LT(SystemClock().now() - got.receive_time, 5s);
  ASSERT_EQ(shell("cansend vcan0 1ABCDEF0##1AABBCCDD"), 0);
  ASSERT_TRUE(receives());
  EXPECT_TRUE(got.frame.extended && got.frame.fd && got.frame.bit_rate_switch);
  EXPECT_EQ(got.frame.id, 0x1ABCDEF0U);
  ASSERT_EQ(shell("cansend vcan0 321#R4"), 0);
  ASSERT_TRUE(receives());
  EXPECT_TRUE(got.frame.remote);
  EXPECT_EQ(got.frame.length, 4);
}

TEST_F(VcanTest, CandumpHearsWhatIsSent) {
  const std::string log = folder + "/candump.txt";
  Background candump("candump -L -n 3 vcan0 > " + log);
  CanFrame fd = data_frame(0x1ABCDEF0, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  fd.extended = true;
  fd.fd = true;
  EXPECT_TRUE(becomes_true([&] {
    sut->send(data_frame(0x181, {0x37, 0x02}));
    sut->send(fd);
    return candump.has_ended();
  }));
  std::stringstream text;
  text << std::ifstream(log).rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("vcan0 181#3702"));
  // Padded to the next FD length, 12; newer kernels set the flag FDF (4) by themselves.
  EXPECT_THAT(text.str(), testing::ContainsRegex("vcan0 1ABCDEF0##[04]010203040506070809000000"));
}

TEST_F(VcanTest, LosesNothingOfAFlood) {
  // -D i: the data count up; -L 8: eight bytes, little-endian.
  Background cangen("cangen vcan0 -g 0 -n 20000 -I 123 -L 8 -D i -p 10");
  std::uint64_t expected = 0;
  for (int i = 0; i < 20'000; ++i) {
    ASSERT_TRUE(receives()) << i;
    std::uint64_t value = 0;
    for (int k = 7; k >= 0; --k) value = value << 8 | got.frame.data[static_cast<std::size_t>(k)];
    if (i == 0) expected = value;
    ASSERT_EQ(value, expected++);
  }
  EXPECT_EQ(sut->status().received, 20'000U);
  EXPECT_EQ(sut->status().receive_dropped, 0U);
}

TEST_F(VcanTest, HearsCanplayer) {
  const std::string log = folder + "/play.log";
  std::ofstream(log) << "(0.000000) vcan0 181#0102\n(0.010000) vcan0 00000182#03\n(0.020000) vcan0 183##3AABB\n";
  const Timestamp played_from = SystemClock().now();
  ASSERT_EQ(shell("canplayer -I " + log), 0);
  const Timestamp played_to = SystemClock().now();
  ASSERT_TRUE(receives());
  EXPECT_EQ(got.frame.id, 0x181U);
  const Timestamp first = got.receive_time;
  ASSERT_TRUE(receives());
  EXPECT_TRUE(got.frame.extended);
  ASSERT_TRUE(receives());
  EXPECT_TRUE(got.frame.error_state_indicator);
  // The kernel's stamps, of when a frame came; all were read after that. The kernel's clock is compared with ours once
  // a frame.
  constexpr auto kClocks = 1ms;
  EXPECT_GE(first, played_from - kClocks);
  EXPECT_GT(got.receive_time, first);
  EXPECT_LE(got.receive_time, played_to + kClocks);
}

TEST_F(VcanTest, SurvivesALinkThatGoesDownAndUp) {
  ASSERT_EQ(shell("ip link set vcan0 down"), 0);
  EXPECT_TRUE(becomes_true([&] { return sut->receive(got, 1ms) == CanReceive::down; }));
  EXPECT_EQ(sut->status().bus, CanBusState::down);
  EXPECT_EQ(sut->status().last_error, kDown);
  EXPECT_FALSE(sut->send(data_frame(1, {})));
  EXPECT_EQ(sut->status().send_refused, 1U);
  EXPECT_EQ(sut->status().last_error, kDown);
  CanChannelConfig config;
  config.endpoint = "socketcan:vcan0";
  const auto opened_down = open_can_channel(config);
  ASSERT_TRUE(opened_down) << opened_down.error().text();
  EXPECT_EQ((*opened_down)->status().bus, CanBusState::down);
  EXPECT_EQ((*opened_down)->status().last_error, kDown);
  ASSERT_EQ(shell("ip link set vcan0 up"), 0);
  ASSERT_EQ(shell("cansend vcan0 123#"), 0);
  ASSERT_TRUE(receives());
  EXPECT_EQ(sut->status().bus, CanBusState::active);
  EXPECT_TRUE(sut->send(data_frame(1, {})));
}

TEST_F(VcanTest, SurvivesAnInterfaceThatIsRemovedAndComesBack) {
  ASSERT_EQ(shell("ip link del vcan0"), 0);
  EXPECT_TRUE(becomes_true([&] { return sut->receive(got, 1ms) == CanReceive::down; }));
  EXPECT_FALSE(sut->send(data_frame(1, {})));
  ASSERT_EQ(shell("ip link add dev vcan0 type vcan && ip link set vcan0 mtu 72 up"), 0);
  EXPECT_TRUE(becomes_true(
      [&] { return shell("cansend vcan0 456#77") == 0 && sut->receive(got, 100ms) == CanReceive::frame; }));
  EXPECT_EQ(got.frame.id, 0x456U);
  EXPECT_GE(sut->status().reopened, 1U);
  EXPECT_EQ(sut->status().bus, CanBusState::active);
}

TEST_F(VcanTest, WhatIsSentMeanwhileDoesNotHideThatTheInterfaceWasRemoved) {
  ASSERT_EQ(shell("ip link del vcan0"), 0);
  for (int i = 0; i < 200; ++i) {
    EXPECT_FALSE(sut->send(data_frame(0x181, {1})));
    sut->receive(got, 5ms);
    EXPECT_THAT(sut->status().last_error,
                testing::AnyOf(HasSubstr("interface vcan0 is down"), HasSubstr("interface vcan0 was removed"),
                               HasSubstr("no network interface vcan0")));
  }
  EXPECT_THAT(sut->status().last_error, HasSubstr("no network interface vcan0"));
  ASSERT_EQ(shell("ip link add dev vcan0 type vcan && ip link set vcan0 mtu 72 up"), 0);
  EXPECT_TRUE(becomes_true([&] {
    sut->receive(got, 5ms);
    return sut->send(data_frame(0x181, {1}));
  }));
}

TEST_F(VcanTest, TellsErrorFrames) {
  ASSERT_EQ(shell("cansend vcan0 20000040#0000000000000000"), 0);  // CAN_ERR_BUSOFF
  ASSERT_TRUE(receives());
  EXPECT_TRUE(got.frame.error);
  EXPECT_EQ(sut->status().bus, CanBusState::bus_off);
  EXPECT_EQ(sut->status().last_error, "bus-off");
  ASSERT_EQ(shell("cansend vcan0 123#"), 0);
  ASSERT_TRUE(receives());
  EXPECT_EQ(sut->status().bus, CanBusState::active);
}

struct Sink : JointSampleSink {
  bool push(const JointSample& sample) noexcept override {
    position = sample.position[0];
    ++count;
    return true;
  }
  std::atomic<double> position{0.0};
  std::atomic<int> count{0};
};

// A drive of the other role on the channel of the test.
class LiveDrive : Cia402DriveOutput {
 public:
  LiveDrive(std::unique_ptr<CanChannel> channel, const Cia402DriveConfig& config)
      : channel_(std::move(channel)), drive_(config, *this), thread_([this] { run(); }) {}
  ~LiveDrive() override {
    stop_ = true;
    thread_.join();
  }

 private:
  void send(const CanFrame& frame) override { channel_->send(frame); }
  void run() {
    drive_.power_on(clock_.now());
    drive_.set_actual(2500, 0, 0, clock_.now());
    while (!stop_) {
      ReceivedCanFrame got;
      if (channel_->receive(got, 1ms) == CanReceive::frame) drive_.receive(got.frame, clock_.now());
      drive_.advance(clock_.now());
    }
  }

  std::unique_ptr<CanChannel> channel_;
  SystemClock clock_;
  Cia402Drive drive_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST_F(VcanTest, AStreamMirrorsADriveThroughALinkFailure) {
  Cia402DriveConfig drive_config;
  drive_config.node_id = 3;
  drive_config.heartbeat_ms = 20;
  const LiveDrive drive(std::move(sut), drive_config);
  Cia402StreamConfig config;
  config.channel.endpoint = "socketcan:vcan0";
  config.sync_period = 5ms;
  Cia402NodeConfig node;
  node.node_id = 3;
  node.joint_name = "J_1";
  node.scale = 0.001;
  node.configure = true;
  config.nodes = {node};
  SystemClock clock;
  Sink sink;
  auto stream = make_cia402_stream(config, clock);
  ASSERT_TRUE(stream) << stream.error().text();
  ASSERT_TRUE((*stream)->open(sink));
  ASSERT_TRUE(becomes_true([&] { return sink.count > 10; })) << (*stream)->status().condition;
  EXPECT_DOUBLE_EQ(sink.position, 2.5);
  ASSERT_EQ(shell("cansend vcan0 083#1186210000000000"), 0);  // an EMCY of node 3
  EXPECT_TRUE(becomes_true([&] {
    const auto details = (*stream)->status().details;
    return std::any_of(details.begin(), details.end(),
                       [](const auto& d) { return d.second.find("0x8611 following error") != std::string::npos; });
  }));
  ASSERT_EQ(shell("ip link set vcan0 down"), 0);
  EXPECT_TRUE(becomes_true([&] { return (*stream)->status().condition == kDown; })) << (*stream)->status().condition;
  ASSERT_EQ(shell("ip link set vcan0 up"), 0);
  const int before = sink.count;
  EXPECT_TRUE(becomes_true([&] { return sink.count > before + 10; })) << (*stream)->status().condition;
  EXPECT_TRUE(becomes_true([&] { return (*stream)->status().condition == "operational"; }))
      << (*stream)->status().condition;
}

}  // namespace
}  // namespace cellmirror::can
