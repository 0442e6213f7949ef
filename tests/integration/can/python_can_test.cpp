// The udp channel against python-can, both directions, on the loopback interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "drivers/can/channel/open_channel.hpp"
#include "drivers/can/stream/streams.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

// Of this process alone.
const std::string kGroup = "239.75." + std::to_string(getpid() >> 8 & 0xFF) + "." + std::to_string(getpid() & 0xFF);
const std::string kPort = std::to_string(20000 + getpid() % 20000);

// The peer with its standard output; ended with its owner.
class Peer {
 public:
  explicit Peer(const std::string& arguments) {
    int ends[2] = {-1, -1};
    if (pipe(ends) != 0) return;
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[1], 1);
      const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
      const std::string command = "exec /usr/bin/python3 " + std::string(source != nullptr ? source : ".") +
                                  "/tests/integration/can/python_can_peer.py " + kGroup + " " + kPort + " " + arguments;
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    close(ends[1]);
    out_ = fdopen(ends[0], "r");
  }
  ~Peer() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    if (out_ != nullptr) std::fclose(out_);
  }
  // Empty at the end of the output.
  std::string line() {
    char buffer[512] = {};
    if (out_ == nullptr || std::fgets(buffer, sizeof buffer, out_) == nullptr) return {};
    std::string text(buffer);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  }

 private:
  pid_t pid_ = -1;
  std::FILE* out_ = nullptr;
};

struct PythonCanTest : testing::Test {
  void SetUp() override {
    if (std::system("/usr/bin/python3 -c 'import can, msgpack' 2>/dev/null") != 0) {
      GTEST_SKIP() << "skipped: no python3-can with msgpack (apt-get install python3-can python3-msgpack)";
    }
    config.endpoint = "udp:" + kGroup + ":" + kPort;
  }
  CanChannelConfig config;
};

TEST_F(PythonCanTest, HearsWhatPythonCanSends) {
  auto sut = open_can_channel(config);
  ASSERT_TRUE(sut) << sut.error().text();
  const Peer peer("send");
  std::vector<CanFrame> frames;
  ReceivedCanFrame got;
  while (frames.size() < 4 && (*sut)->receive(got, 60s) == CanReceive::frame) frames.push_back(got.frame);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[0].id, 0x181U);
  EXPECT_FALSE(frames[0].extended);
  EXPECT_EQ(frames[0].length, 4);
  EXPECT_EQ(frames[0].data[3], 4);
  EXPECT_TRUE(frames[1].extended);
  EXPECT_EQ(frames[1].id, 0x1ABCDEF0U);
  EXPECT_TRUE(frames[2].remote);
  EXPECT_EQ(frames[2].length, 4);
  EXPECT_TRUE(frames[3].fd && frames[3].bit_rate_switch);
  EXPECT_EQ(frames[3].length, 64);
  EXPECT_EQ(frames[3].data[63], 0x5A);
  EXPECT_EQ((*sut)->status().malformed, 0U);
}

TEST_F(PythonCanTest, PythonCanHearsWhatIsSent) {
  auto sut = open_can_channel(config);
  ASSERT_TRUE(sut) << sut.error().text();
  Peer peer("receive 4");
  ASSERT_EQ(peer.line(), "ready");
  CanFrame frame;
  frame.id = 0x181;
  frame.length = 2;
  frame.data = {0x37, 0x02};
  EXPECT_TRUE((*sut)->send(frame));
  frame.extended = true;
  frame.id = 0x1ABCDEF0;
  EXPECT_TRUE((*sut)->send(frame));
  frame.fd = true;
  frame.bit_rate_switch = true;
  frame.length = 12;
  EXPECT_TRUE((*sut)->send(frame));
  CanFrame remote;
  remote.id = 0x123;
  remote.remote = true;
  remote.length = 4;
  EXPECT_TRUE((*sut)->send(remote));
  EXPECT_EQ(peer.line(), "181 ext=0 rtr=0 fd=0 brs=0 dlc=2 3702");
  EXPECT_EQ(peer.line(), "1abcdef0 ext=1 rtr=0 fd=0 brs=0 dlc=2 3702");
  EXPECT_EQ(peer.line(), "1abcdef0 ext=1 rtr=0 fd=1 brs=1 dlc=12 370200000000000000000000");
  EXPECT_EQ(peer.line(), "123 ext=0 rtr=1 fd=0 brs=0 dlc=4 ");
}

struct Sink : JointSampleSink {
  bool push(const JointSample& sample) noexcept override {
    if (sample.position[0] != last_position + 1.0 && count > 0) ++gaps;
    last_position = sample.position[0];
    ++count;
    return true;
  }
  std::atomic<double> last_position{0.0};
  std::atomic<int> count{0};
  std::atomic<int> gaps{0};
};

TEST_F(PythonCanTest, AStreamStartsAndMirrorsANodeMadeOfPython) {
  Cia402StreamConfig stream_config;
  stream_config.channel = config;
  Cia402NodeConfig node;
  node.node_id = 5;
  node.joint_name = "J_1";
  stream_config.nodes = {node};
  SystemClock clock;
  Sink sink;
  auto sut = make_cia402_stream(stream_config, clock);
  ASSERT_TRUE(sut) << sut.error().text();
  ASSERT_TRUE((*sut)->open(sink));
  Peer peer("node 5");
  EXPECT_EQ(peer.line(), "started") << "the boot-up is answered with NMT start";
  for (int i = 0; i < 6000 && sink.count < 50; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_GE(sink.count, 50);
  EXPECT_GE(sink.last_position, 1049.0);
  EXPECT_EQ(sink.gaps, 0);
  EXPECT_EQ((*sut)->status().condition, "operational");
  EXPECT_EQ((*sut)->status().rejected, 0U);
}

}  // namespace
}  // namespace cellmirror::can
