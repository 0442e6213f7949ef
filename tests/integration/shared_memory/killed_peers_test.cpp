// kill -9 on either side, again and again: the other one notices, goes on, and nothing is left over.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "drivers/haptic/shared_memory_device.hpp"
#include "ipc/sysv/force_guard.hpp"
#include "ipc/sysv/process_watch.hpp"
#include "ipc/sysv/shared_segment.hpp"
#include "ipc/wire/haptic_block.hpp"
#include "tests/integration/ipc/own_ipc.hpp"
#include "tests/integration/shared_memory/derived_block.hpp"

namespace cellmirror {
namespace {

constexpr int kDeaths = 50;
volatile sig_atomic_t asked_to_end = 0;

SharedSegment::Options options_of(std::int32_t key) {
  return {"haptic device of TEST", key, haptic_block_offset::kSize, 0600, "test"};
}
std::int32_t own_key() { return test::own_queues().script_key; }

// A device that writes at full speed, so that it often dies half way.
[[noreturn]] void be_a_device(std::int32_t key) {
  auto attached = AttachedSegment::attach(key, haptic_block_offset::kSize, false);
  if (!attached) _exit(1);
  for (std::uint64_t i = 1;; ++i) write_haptic_sample(attached->memory(), test::derived_sample(i));
}

// A gateway that writes at full speed and answers the sample that it has read. Ends in good order at SIGTERM.
// With a guard whose number goes to `report`, where there is one.
[[noreturn]] void be_a_gateway(std::int32_t key, std::optional<int> report = {}) {
  ::signal(SIGTERM, [](int) { asked_to_end = 1; });
  {
    std::unique_ptr<ForceGuard> guard;
    SharedSegment::Options options = options_of(key);
    if (report) {
      guard = std::move(*ForceGuard::start());
      options.guard = guard.get();
      options.block = GuardedBlock::haptic;
      const pid_t number = guard->process();
      if (::write(*report, &number, sizeof number) != sizeof number) _exit(1);
    }
    auto segment = SharedSegment::make(options);
    if (!segment) {
      std::fprintf(stderr, "%s\n", segment.error().text().c_str());
      _exit(1);
    }
    haptic::SharedMemoryDevice device((*segment)->memory(), 4, static_cast<std::uint32_t>(::getpid()));
    HapticSample sample;
    HapticOutput output;
    output.force_D = {1, 2, 3};
    while (asked_to_end == 0) {
      if (device.read(sample) == HapticRead::fresh) output.answers = sample.sequence;
      ++output.sequence;
      output.time = SystemClock().now();
      device.write(output);
    }
  }
  _exit(0);
}

template <class Work>
pid_t start(Work work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    _exit(1);
  }
  return child;
}

int end(pid_t child, int signal_number) {
  ::kill(child, signal_number);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// At most two seconds, where the machine has nothing else to do.
template <class Condition>
bool soon(Condition condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    ::usleep(50);
  }
  return true;
}

// Also where nobody has collected it: its parent is dead.
bool has_ended(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(in, text);
  return text.empty() || text.find(") Z ") != std::string::npos;
}

bool segment_exists(std::int32_t key) { return ::shmget(key, 0, 0) >= 0; }

TEST(KilledPeers, GatewayNoticesADeviceThatDiesAndGoesOnWithTheNextOne) {
  const std::int32_t key = own_key();
  const auto segment = SharedSegment::make(options_of(key));
  ASSERT_TRUE(segment) << segment.error().text();
  haptic::SharedMemoryDevice sut((*segment)->memory(), 4, static_cast<std::uint32_t>(::getpid()));
  ProcessWatch watch;
  HapticSample sample;
  int died_half_way = 0;
  for (int death = 0; death < kDeaths; ++death) {
    const pid_t device = start([&] { be_a_device(key); });
    const auto number = static_cast<std::uint32_t>(device);
    const bool heard = soon([&] { return sut.read(sample) == HapticRead::fresh && sample.writer == number; });
    EXPECT_GE((*segment)->users().attached, 2u);  // a forked child has its parent's besides its own
    EXPECT_FALSE(watch.has_ended(number));
    ::usleep(static_cast<useconds_t>(37 * death));
    end(device, SIGKILL);
    ASSERT_TRUE(heard) << "death " << death;
    EXPECT_EQ((*segment)->users().attached, 1u);
    EXPECT_TRUE(watch.has_ended(number));
    EXPECT_FALSE((*segment)->users().gone);
    HapticRead read = sut.read(sample);
    if (read == HapticRead::fresh) {
      EXPECT_TRUE(test::is_derived(sample));
      read = sut.read(sample);
    }
    if (read == HapticRead::torn) ++died_half_way;
    EXPECT_TRUE(read == HapticRead::unchanged || read == HapticRead::torn) << "nothing comes from the dead";
  }
  std::printf("  %d of %d died half way through a write\n", died_half_way, kDeaths);
}

TEST(KilledPeers, DeviceNoticesAGatewayThatDiesAndGoesOnWithTheNextOne) {
  const std::int32_t key = own_key();
  std::optional<AttachedSegment> attached;
  std::uint64_t sequence = 0;
  HapticOutput felt;
  for (int death = 0; death <= kDeaths; ++death) {
    const pid_t gateway = start([&] { be_a_gateway(key); });
    const auto number = static_cast<std::uint32_t>(gateway);
    const bool answered = soon([&] {
      if (!attached) {
        if (auto found = AttachedSegment::attach(key, haptic_block_offset::kSize, false))
          attached.emplace(std::move(*found));
        return false;
      }
      HapticSample sample = test::derived_sample(++sequence);
      write_haptic_sample(attached->memory(), sample);
      return haptic_block_gateway(attached->memory()) == number && read_haptic_output(attached->memory(), felt) &&
             felt.answers > 0 && felt.force_D == Eigen::Vector3d(1, 2, 3);
    });
    if (!answered) end(gateway, SIGKILL);
    ASSERT_TRUE(answered) << "death " << death;
    EXPECT_FALSE(attached->removed()) << "it was taken over, not made anew";
    if (death == kDeaths) {
      EXPECT_EQ(end(gateway, SIGTERM), 0);
      break;
    }
    ::usleep(static_cast<useconds_t>(37 * death));
    end(gateway, SIGKILL);
    const Timestamp after = SystemClock().now();
    EXPECT_FALSE(process_exists(number));
    EXPECT_FALSE(attached->removed()) << "a killed gateway removes nothing";
    if (read_haptic_output(attached->memory(), felt)) {
      EXPECT_LT(felt.time, after) << "its age tells";
    }
  }
  EXPECT_TRUE(attached->removed());
  EXPECT_EQ(haptic_block_gateway(attached->memory()), 0u);
  ASSERT_TRUE(read_haptic_output(attached->memory(), felt));
  EXPECT_EQ(felt.force_D, Eigen::Vector3d::Zero());
  EXPECT_FALSE(segment_exists(key));
}

TEST(KilledPeers, WhatBothLeftBehindIsTakenAndRemoved) {
  const std::int32_t key = own_key();
  for (int death = 0; death < 10; ++death) {
    const pid_t gateway = start([&] { be_a_gateway(key); });
    const bool made = soon([&] { return segment_exists(key); });
    pid_t device = start([&] { be_a_device(key); });
    ::usleep(static_cast<useconds_t>(200 * death));
    end(death % 2 == 0 ? device : gateway, SIGKILL);
    end(death % 2 == 0 ? gateway : device, SIGKILL);
    ASSERT_TRUE(made);
  }
  ASSERT_TRUE(segment_exists(key)) << "nobody was left to remove it";
  {
    const auto sut = SharedSegment::make(options_of(key));
    ASSERT_TRUE(sut) << sut.error().text();
    EXPECT_FALSE((*sut)->taken_over());
    std::uint64_t last = 0;
    HapticSample sample;
    EXPECT_EQ(read_haptic_sample((*sut)->memory(), last, sample), HapticRead::none) << "no sample of the dead";
  }
  EXPECT_FALSE(segment_exists(key));
}

// A device that is attached, and a gateway with a guard that has answered it.
class Guarded : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(::pipe(pipe_), 0); }
  void TearDown() override {
    ::close(pipe_[0]);
    ::close(pipe_[1]);
  }
  pid_t start_gateway() {
    const pid_t gateway = start([&] { be_a_gateway(key_, pipe_[1]); });
    EXPECT_EQ(::read(pipe_[0], &guard_, sizeof guard_), static_cast<ssize_t>(sizeof guard_));
    const auto number = static_cast<std::uint32_t>(gateway);
    EXPECT_TRUE(soon([&] {
      if (!attached_) {
        if (auto found = AttachedSegment::attach(key_, haptic_block_offset::kSize, false))
          attached_.emplace(std::move(*found));
        return false;
      }
      write_haptic_sample(attached_->memory(), test::derived_sample(++sequence_));
      return is_felt(number);
    }));
    return gateway;
  }
  bool is_felt(std::uint32_t gateway) {
    return haptic_block_gateway(attached_->memory()) == gateway && read_haptic_output(attached_->memory(), felt_) &&
           felt_.answers > 0 && felt_.force_D == Eigen::Vector3d(1, 2, 3);
  }
  bool nothing_is_felt() {
    return haptic_block_gateway(attached_->memory()) == 0 && read_haptic_output(attached_->memory(), felt_) &&
           felt_.force_D == Eigen::Vector3d::Zero() && felt_.phase == 0;
  }

  std::int32_t key_ = own_key();
  int pipe_[2] = {-1, -1};
  pid_t guard_ = 0;
  std::optional<AttachedSegment> attached_;
  std::uint64_t sequence_ = 0;
  HapticOutput felt_;
};

TEST_F(Guarded, KilledGatewayLeavesNoForce) {
  for (int death = 0; death < kDeaths; ++death) {
    const pid_t gateway = start_gateway();
    ::usleep(static_cast<useconds_t>(37 * death));
    end(gateway, SIGKILL);
    ASSERT_TRUE(soon([&] { return nothing_is_felt(); })) << "death " << death;
    EXPECT_TRUE(soon([&] { return has_ended(guard_); }));
    EXPECT_FALSE(attached_->removed()) << "it stays for the next gateway";
  }
  EXPECT_EQ(end(start_gateway(), SIGTERM), 0);
  EXPECT_TRUE(nothing_is_felt());
  EXPECT_TRUE(attached_->removed());
}

TEST_F(Guarded, LateGuardLeavesTheNextGatewayAlone) {
  const pid_t first = start_gateway();
  const pid_t late = guard_;
  ::kill(late, SIGSTOP);
  end(first, SIGKILL);
  const pid_t second = start_gateway();
  ::kill(late, SIGCONT);
  EXPECT_TRUE(soon([&] { return has_ended(late); }));
  const std::uint64_t before = felt_.sequence;
  EXPECT_TRUE(soon([&] { return is_felt(static_cast<std::uint32_t>(second)) && felt_.sequence > before; }));
  EXPECT_EQ(end(second, SIGTERM), 0);
}

TEST_F(Guarded, RenewedMemoryIsGuardedToo) {
  const pid_t child = start([&] {
    auto guard = std::move(*ForceGuard::start());
    SharedSegment::Options options = options_of(key_);
    options.guard = guard.get();
    options.block = GuardedBlock::haptic;
    auto segment = SharedSegment::make(options);
    haptic::SharedMemoryDevice device((*segment)->memory(), 4, static_cast<std::uint32_t>(::getpid()));
    ::shmctl(::shmget(key_, 0, 0), IPC_RMID, nullptr);
    if (!segment || !(*segment)->renew()) _exit(1);
    HapticOutput output;
    output.force_D = {1, 2, 3};
    output.answers = 1;
    for (;;) device.write(output);
  });
  ASSERT_TRUE(soon([&] {
    if (!attached_ || attached_->removed()) {
      attached_.reset();
      if (auto found = AttachedSegment::attach(key_, haptic_block_offset::kSize, false))
        attached_.emplace(std::move(*found));
      return false;
    }
    return is_felt(static_cast<std::uint32_t>(child));
  }));
  end(child, SIGKILL);
  EXPECT_TRUE(soon([&] { return nothing_is_felt(); }));
  ::shmctl(::shmget(key_, 0, 0), IPC_RMID, nullptr);
  test::remove_semaphore(key_);
}

TEST(ForceGuard, ForgetsWhatIsGone) {
  auto sut = std::move(*ForceGuard::start());
  for (int i = 0; i < static_cast<int>(ForceGuard::kMostBlocks); ++i) EXPECT_TRUE(sut->watch(i, GuardedBlock::haptic));
  EXPECT_FALSE(sut->watch(99, GuardedBlock::haptic)) << "the list is full";
  sut->forget(0);
  EXPECT_TRUE(sut->watch(99, GuardedBlock::tcp_force));
  for (int i = 0; i < 100; ++i) sut->forget(i);
  EXPECT_TRUE(sut->running());
  ::kill(sut->process(), SIGKILL);
  EXPECT_TRUE(soon([&] { return !sut->running(); }));
}

}  // namespace
}  // namespace cellmirror
