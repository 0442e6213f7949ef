// Peers in other languages: consistent blocks under a million updates, and the programs of docs/examples.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "drivers/haptic/shared_memory_device.hpp"
#include "ipc/sysv/shared_segment.hpp"
#include "ipc/wire/haptic_block.hpp"
#include "ipc/wire/tcp_force_block.hpp"
#include "tests/integration/ipc/child_process.hpp"
#include "tests/integration/ipc/own_ipc.hpp"
#include "tests/integration/shared_memory/derived_block.hpp"

namespace cellmirror {
namespace {

using test::ChildProcess;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}
std::string program(const char* name) { return environment("CELLMIRROR_BIN_DIR") + "/" + name; }
std::string examples() { return environment("CELLMIRROR_SOURCE_DIR") + "/docs/examples"; }
std::int32_t own_key() { return test::own_queues().script_key; }

class SharedMemoryPeers : public ::testing::Test {
 protected:
  void SetUp() override {
    if (environment("CELLMIRROR_BIN_DIR").empty()) GTEST_SKIP() << "skipped: CELLMIRROR_BIN_DIR is not set, use ctest";
    auto made = SharedSegment::make({"test", key_, haptic_block_offset::kSize, 0600, "test"});
    ASSERT_TRUE(made) << made.error().text();
    segment_ = std::move(*made);
  }
  std::vector<std::string> c_peer(const char* what, const std::vector<std::uint64_t>& numbers) const {
    return with({program("shared_memory_derived_peer"), what, std::to_string(key_)}, numbers);
  }
  std::vector<std::string> python_peer(const char* what, const std::vector<std::uint64_t>& numbers) const {
    return with({"/usr/bin/python3", "-B",
                 environment("CELLMIRROR_SOURCE_DIR") + "/tests/integration/shared_memory/derived_peer.py", examples(),
                 what, std::to_string(key_)},
                numbers);
  }
  static std::vector<std::string> with(std::vector<std::string> command, const std::vector<std::uint64_t>& numbers) {
    for (const std::uint64_t number : numbers) command.push_back(std::to_string(number));
    return command;
  }
  // Reads what `writer` writes until it has ended; then the last of it has to be there.
  void read_from(std::vector<std::string> writer, std::uint64_t last) {
    ChildProcess child(std::move(writer));
    std::uint64_t lock = 0;
    std::uint64_t fresh = 0;
    std::uint64_t wrong = 0;
    std::uint64_t newest = 0;
    HapticSample sample;
    for (bool ended = false; !ended;) {
      siginfo_t info{};
      ::waitid(P_PID, static_cast<id_t>(child.pid()), &info, WEXITED | WNOHANG | WNOWAIT);
      ended = info.si_pid != 0;
      for (int i = 0; i < 1000; ++i) {
        if (read_haptic_sample(segment_->memory(), lock, sample) != HapticRead::fresh) continue;
        ++fresh;
        if (!test::is_derived(sample) || sample.sequence <= newest ||
            sample.writer != static_cast<std::uint32_t>(child.pid())) {
          ++wrong;
        }
        newest = sample.sequence;
      }
    }
    EXPECT_EQ(child.wait(), 0) << child.errors();
    EXPECT_EQ(wrong, 0u);
    EXPECT_GE(fresh, 1u);  // how many depends on how often the two run at the same time
    EXPECT_EQ(newest, last);
  }

  std::int32_t key_ = own_key();
  std::unique_ptr<SharedSegment> segment_;
};

struct Seen {
  unsigned long long whole = 0;
  unsigned long long retried = 0;
  unsigned long long inconsistent = 1;
  unsigned long long last = 0;
};
Seen seen_by(ChildProcess& reader) {
  Seen seen;
  EXPECT_EQ(reader.wait(), 0) << reader.errors();
  std::printf("  %s", reader.output().c_str());
  EXPECT_EQ(std::sscanf(reader.output().c_str(), "whole %llu retried %llu inconsistent %llu last %llu", &seen.whole,
                        &seen.retried, &seen.inconsistent, &seen.last),
            4)
      << reader.output();
  return seen;
}

// Writes at about 300,000 a second, 300 times the rate of a gateway: at full speed a reader that needs microseconds for
// a copy would hardly ever find a moment. Goes on beyond a million until both readers have met enough different blocks,
// which takes longer where other programs take the processors; the readers give up after five minutes.
TEST_F(SharedMemoryPeers, ReadersInCAndPythonSeeConsistentBlocksUnderAMillionUpdates) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  constexpr std::uint64_t kUpdates = 100'000;  // a sanitizer's writes take most of the time from the readers
#else
  constexpr std::uint64_t kUpdates = 1'000'000;
#endif
  constexpr std::uint64_t kLast = 1'000'000'000;  // written at the end
  constexpr std::uint64_t kManyInC = kUpdates / 100;
  constexpr std::uint64_t kManyInPython = kUpdates / 400;
  prepare_haptic_block(segment_->memory(), 16, 1);
  ChildProcess in_c(c_peer("read", {kLast, kManyInC}));
  ChildProcess in_python(python_peer("read", {kLast, kManyInPython}));
  ASSERT_EQ(in_c.line(), "ready");
  ASSERT_EQ(in_python.line(), "ready");
  std::atomic<bool> enough{false};
  std::thread watch([&] {
    for (ChildProcess* reader : {&in_c, &in_python}) EXPECT_EQ(reader->line(), "enough");
    enough = true;
  });
  auto next = std::chrono::steady_clock::now();
  for (std::uint64_t i = 1; i <= kUpdates || !enough; ++i) {
    write_haptic_output(segment_->memory(), test::derived_output(i));
    next += std::chrono::nanoseconds(3000);
    if (i % 16 == 0 && !enough) {
      std::this_thread::yield();  // where it shares a processor with a reader, both have to run
      next = std::max(next, std::chrono::steady_clock::now());
    }
    while (std::chrono::steady_clock::now() < next) {
    }
  }
  watch.join();
  write_haptic_output(segment_->memory(), test::derived_output(kLast));
  const Seen c = seen_by(in_c);
  const Seen python = seen_by(in_python);
  EXPECT_EQ(c.inconsistent + python.inconsistent, 0u);
  EXPECT_EQ(c.last, kLast);
  EXPECT_EQ(python.last, kLast);
  EXPECT_GE(c.whole, kManyInC) << "different ones";
  EXPECT_GE(python.whole, kManyInPython) << "different ones";
}

TEST_F(SharedMemoryPeers, SamplesOfAWriterInCAreConsistent) { read_from(c_peer("write", {1'000'000}), 1'000'000); }

TEST_F(SharedMemoryPeers, SamplesOfAWriterInPythonAreConsistent) { read_from(python_peer("write", {50'000}), 50'000); }

// A gateway's tick, as far as the block is concerned.
class Ticking {
 public:
  explicit Ticking(std::span<std::byte> memory) : device_(memory, 4, static_cast<std::uint32_t>(::getpid())) {
    thread_ = std::thread([this] { run(); });
  }
  ~Ticking() {
    over_ = true;
    thread_.join();
  }
  Ticking(const Ticking&) = delete;
  Ticking& operator=(const Ticking&) = delete;

  [[nodiscard]] std::uint64_t cycles() const { return cycles_; }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] bool last_valid() const { return last_valid_; }

 private:
  void run() {
    HapticSample sample;
    HapticOutput output;
    output.phase = 4;
    output.joint_count = 4;
    output.joint_torques[0] = 0.25;
    output.force_E = {1, 2, 3};
    output.force_D = {0, 0, 1.5};
    while (!over_) {
      if (device_.read(sample) == HapticRead::fresh) {
        ++samples_;
        last_valid_ = sample.valid;
      }
      ++output.sequence;
      output.time = SystemClock().now();
      device_.write(output);
      ++cycles_;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  haptic::SharedMemoryDevice device_;
  std::atomic<bool> over_{false};
  std::atomic<std::uint64_t> cycles_{0};
  std::atomic<std::uint64_t> samples_{0};
  std::atomic<bool> last_valid_{false};
  std::thread thread_;
};

TEST_F(SharedMemoryPeers, ExampleDevicesWritePosesAndFeelForces) {
  const Ticking tick(segment_->memory());
  const std::vector<std::vector<std::string>> devices = {{program("shared_memory_example_haptic_device")},
                                                         {"/usr/bin/python3", "-B", examples() + "/haptic_device.py"}};
  for (std::vector<std::string> command : devices) {
    const std::uint64_t before = tick.samples();
    for (const std::string& word :
         {std::string("--key"), std::to_string(key_), std::string("--seconds"), std::string("0.6")}) {
      command.push_back(word);
    }
    ChildProcess sut(command);
    EXPECT_EQ(sut.wait(), 0) << sut.errors();
    EXPECT_NE(sut.output().find(" active none force 0.000 0.000 1.500 N age "), std::string::npos) << sut.output();
    EXPECT_GT(tick.samples(), before + 5);
    for (int i = 0; i < 60'000 && tick.last_valid(); ++i) ::usleep(1000);
    EXPECT_FALSE(tick.last_valid()) << "the last word of a device that ends";
  }
}

TEST_F(SharedMemoryPeers, ExampleDeviceWithoutAGatewaySaysSo) {
  segment_.reset();
  for (const std::string& name : {program("shared_memory_example_haptic_device"), examples() + "/haptic_device.py"}) {
    ChildProcess sut({name, "--key", std::to_string(key_)});
    EXPECT_EQ(sut.wait(), 1);
    EXPECT_NE(sut.errors().find("no gateway is running"), std::string::npos) << sut.errors();
  }
}

TEST_F(SharedMemoryPeers, ProgramsOf1999ReadTheFirstFloats) {
  const Ticking tick(segment_->memory());
  for (int i = 0; i < 60'000 && tick.cycles() < 2; ++i) ::usleep(1000);
  ChildProcess perl({"perl", examples() + "/force_reader_1999.pl", std::to_string(key_), "7"});
  EXPECT_EQ(perl.wait(), 0) << perl.errors();
  EXPECT_EQ(perl.output(), "1.000 2.000 3.000 0.250 0.000 0.000 0.000\n");
}

TEST_F(SharedMemoryPeers, ExampleReadersPrintTheForceAtTheTcp) {
  const std::int32_t key = own_key();
  const auto made = SharedSegment::make({"TCP force", key, tcp_force_block_offset::kSize, 0600, "test"});
  ASSERT_TRUE(made) << made.error().text();
  TcpForce force;
  force.values = {1, -2, 0.5f, 0.25f};
  force.sequence = 7;
  force.flags = kTcpForceValid | kTcpForceTest;
  force.process = static_cast<std::uint32_t>(::getpid());
  force.robot = std::string_view("PUMA_762");
  // Readers show only what is current.
  const std::jthread writer([&, force](const std::stop_token& stop) mutable {
    while (!stop.stop_requested()) {
      force.time = SystemClock().now();
      write_tcp_force((*made)->memory(), force);
      ::usleep(1000);
    }
  });
  const std::string number = std::to_string(key);
  for (const std::string& name :
       {program("shared_memory_example_tcp_force_reader"), examples() + "/tcp_force_reader.py"}) {
    ChildProcess sut({name, "--key", number, "--count", "1", "--timeout", "60"});
    EXPECT_EQ(sut.wait(), 0) << sut.errors();
    EXPECT_EQ(sut.output(), "7 PUMA_762 force 1.000 -2.000 0.500 N torque 0.250 Nm valid test\n");
  }
  ChildProcess old({program("shared_memory_example_tcp_force_reader"), "--old", "--key", number});
  EXPECT_EQ(old.wait(), 0) << old.errors();
  EXPECT_EQ(old.output(), "1.000 -2.000 0.500 0.250\n");
  ChildProcess perl({"perl", examples() + "/force_reader_1999.pl", number, "4"});
  EXPECT_EQ(perl.wait(), 0) << perl.errors();
  EXPECT_EQ(perl.output(), "1.000 -2.000 0.500 0.250\n");
}

}  // namespace
}  // namespace cellmirror
