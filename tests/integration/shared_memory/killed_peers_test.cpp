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
#include <optional>
#include <string>

#include "drivers/haptic/shared_memory_device.hpp"
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
[[noreturn]] void be_a_gateway(std::int32_t key) {
  ::signal(SIGTERM, [](int) { asked_to_end = 1; });
  {
    auto segment = SharedSegment::make(options_of(key));
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

// At most two seconds, ten with a slow sanitizer.
template <class Condition>
bool soon(Condition condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    ::usleep(50);
  }
  return true;
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

}  // namespace
}  // namespace cellmirror
