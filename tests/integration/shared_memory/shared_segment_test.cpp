#include "ipc/sysv/shared_segment.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ipc.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/integration/ipc/own_ipc.hpp"

namespace cellmirror {
namespace {

constexpr uid_t kNobody = 65534;

// Keys of memories and of queues are different things, so that a queue's will do.
std::int32_t own_key() { return test::own_queues().script_key; }

SharedSegment::Options options_of(std::int32_t key, std::size_t bytes = 512) {
  return {"test", key, bytes, 0600, "test"};
}
bool segment_exists(std::int32_t key) { return ::shmget(key, 0, 0) >= 0 || errno != ENOENT; }
int make_segment(std::int32_t key, std::size_t bytes, int mode) {
  return ::shmget(key, bytes, IPC_CREAT | IPC_EXCL | mode);
}
void remove_segment(std::int32_t key) {
  const int id = ::shmget(key, 0, 0);
  if (id >= 0) ::shmctl(id, IPC_RMID, nullptr);
}
unsigned mode_of(std::int32_t key) {
  shmid_ds found{};
  ::shmctl(::shmget(key, 0, 0), IPC_STAT, &found);
  return found.shm_perm.mode & 0777u;
}
bool all_zero(std::span<const std::byte> memory) {
  return std::all_of(memory.begin(), memory.end(), [](std::byte b) { return b == std::byte{0}; });
}
// What a program that knows nothing of cellmirror does.
struct Stranger {
  explicit Stranger(std::int32_t key) : memory(static_cast<std::byte*>(::shmat(::shmget(key, 0, 0), nullptr, 0))) {}
  ~Stranger() { ::shmdt(memory); }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;
  std::byte* memory;
};
// The exit status of what a child does; children of the test must not run its destructors.
template <class Work>
int in_child(Work work) {
  const pid_t child = ::fork();
  if (child == 0) _exit(work());
  int status = -1;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(SharedSegment, IsMadeZeroedWithItsModeAndRemoved) {
  const std::int32_t key = own_key();
  {
    const auto sut = SharedSegment::make(options_of(key));
    ASSERT_TRUE(sut) << sut.error().text();
    EXPECT_EQ((*sut)->memory().size(), 512u);
    EXPECT_TRUE(all_zero((*sut)->memory()));
    EXPECT_EQ(mode_of(key), 0600u);
    EXPECT_FALSE((*sut)->taken_over());
    const SegmentUsers users = (*sut)->users();
    EXPECT_FALSE(users.gone);
    EXPECT_EQ(users.attached, 1u);
    EXPECT_EQ(users.last_process, ::getpid());
  }
  EXPECT_FALSE(segment_exists(key));
}

TEST(SharedSegment, ImpossibleSizesAreRefused) {
  for (const std::size_t bytes : {std::size_t{0}, kMaxSegmentBytes + 1}) {
    const std::int32_t key = own_key();
    const auto sut = SharedSegment::make(options_of(key, bytes));
    ASSERT_FALSE(sut);
    EXPECT_NE(sut.error().what.find(std::to_string(bytes) + " bytes"), std::string::npos) << sut.error().text();
    EXPECT_FALSE(segment_exists(key));
  }
}

TEST(SharedSegment, SecondOwnerIsRefusedWithTheProcess) {
  const std::int32_t key = own_key();
  const auto first = SharedSegment::make(options_of(key));
  ASSERT_TRUE(first);
  const auto sut = SharedSegment::make(options_of(key));
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("process " + std::to_string(::getpid())), std::string::npos) << sut.error().text();
  EXPECT_TRUE(segment_exists(key)) << "the refused one must not remove the first one's memory";
}

TEST(SharedSegment, WhatWasLeftBehindIsZeroed) {
  const std::int32_t key = own_key();
  ASSERT_GE(make_segment(key, 512, 0600), 0);
  {
    const Stranger stranger(key);
    stranger.memory[5] = std::byte{7};
  }
  const auto sut = SharedSegment::make(options_of(key));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_TRUE(all_zero((*sut)->memory()));
  EXPECT_FALSE((*sut)->taken_over());
}

TEST(SharedSegment, WhatADeviceMadeBeforeIsTakenAsItStands) {
  const std::int32_t key = own_key();
  ASSERT_GE(make_segment(key, 4096, 0400 | 0200), 0);
  const Stranger device(key);
  device.memory[5] = std::byte{7};
  SharedSegment::Options options = options_of(key);
  options.mode = 0660;
  const auto sut = SharedSegment::make(options);
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_TRUE((*sut)->taken_over());
  EXPECT_EQ((*sut)->memory()[5], std::byte{7});
  EXPECT_EQ((*sut)->memory().size(), 512u);
  EXPECT_EQ((*sut)->users().attached, 2u);
  EXPECT_EQ(mode_of(key), 0660u) << "the cell file's mode";
  (*sut)->memory()[6] = std::byte{8};
  EXPECT_EQ(device.memory[6], std::byte{8});
}

TEST(SharedSegment, TooSmallAndUnusedIsReplaced) {
  const std::int32_t key = own_key();
  ASSERT_GE(make_segment(key, 12, 0600), 0);
  const auto sut = SharedSegment::make(options_of(key));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ((*sut)->memory().size(), 512u);
}

TEST(SharedSegment, TooSmallAndInUseIsRefusedAndNotTouched) {
  const std::int32_t key = own_key();
  ASSERT_GE(make_segment(key, 12, 0600), 0);
  {
    const Stranger device(key);
    const auto sut = SharedSegment::make(options_of(key));
    ASSERT_FALSE(sut);
    EXPECT_NE(sut.error().what.find("has 12 bytes, but 512 are needed"), std::string::npos) << sut.error().text();
    EXPECT_NE(sut.error().remedy.find("process " + std::to_string(::getpid())), std::string::npos);
    EXPECT_NE(sut.error().remedy.find("ipcrm -M"), std::string::npos);
  }
  EXPECT_TRUE(segment_exists(key));
  remove_segment(key);
}

TEST(SharedSegment, MuchLargerOneServesAnotherPurpose) {
  const std::int32_t key = own_key();
  ASSERT_GE(make_segment(key, 2 * kMaxSegmentBytes, 0600), 0);
  EXPECT_FALSE(SharedSegment::make(options_of(key)));
  EXPECT_TRUE(segment_exists(key));
  remove_segment(key);
}

TEST(SharedSegment, WiderModeIsRefusedWithTheCommandThatMendsIt) {
  const std::int32_t key = own_key();
  ASSERT_GE(make_segment(key, 512, 0666), 0);
  const auto sut = SharedSegment::make(options_of(key));
  ASSERT_FALSE(sut);
  char command[32];
  std::snprintf(command, sizeof command, "ipcrm -M %#x", static_cast<unsigned>(key));
  EXPECT_NE(sut.error().remedy.find(command), std::string::npos) << sut.error().text();
  EXPECT_NE(sut.error().what.find("666"), std::string::npos);
  EXPECT_EQ(mode_of(key), 0666u) << "what is refused is not touched";
  SharedSegment::Options wide = options_of(key);
  wide.mode = 0666;
  EXPECT_TRUE(SharedSegment::make(wide)) << "the cell file may allow it";
  EXPECT_FALSE(segment_exists(key));
}

TEST(SharedSegment, OfAnotherUserIsRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: only root can make one of another user";
  const std::int32_t key = own_key();
  ASSERT_EQ(in_child([&] {
              return ::setresuid(kNobody, kNobody, kNobody) == 0 && make_segment(key, 512, 0600) >= 0 ? 0 : 1;
            }),
            0);
  const auto sut = SharedSegment::make(options_of(key));
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("another user"), std::string::npos) << sut.error().text();
  EXPECT_NE(sut.error().what.find("uid 65534"), std::string::npos) << sut.error().text();
  EXPECT_NE(sut.error().remedy.find("ipcrm -m " + std::to_string(::shmget(key, 0, 0))), std::string::npos);
  const auto attached = AttachedSegment::attach(key, 512, true);
  ASSERT_FALSE(attached);
  EXPECT_NE(attached.error().what.find("another user"), std::string::npos) << attached.error().text();
  EXPECT_TRUE(segment_exists(key));
  remove_segment(key);
}

// The same seen by an ordinary user, who may not even look at root's memory.
TEST(SharedSegment, OfRootIsRefusedToAnOrdinaryUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: only root can become another user";
  const std::int32_t key = own_key();
  ASSERT_GE(make_segment(key, 512, 0600), 0);
  const int refused = in_child([&] {
    if (::setresuid(kNobody, kNobody, kNobody) != 0) return 2;
    ::setenv("CELLMIRROR_RUNTIME_DIR", ("/tmp/cellmirror-test-nobody-" + std::to_string(::getpid())).c_str(), 1);
    const auto sut = SharedSegment::make(options_of(key));
    const auto attached = AttachedSegment::attach(key, 512, true);
    const bool good = !sut && sut.error().what.find("another user") != std::string::npos && !attached;
    std::error_code ignored;
    std::filesystem::remove_all(std::getenv("CELLMIRROR_RUNTIME_DIR"), ignored);
    return good ? 0 : 1;
  });
  EXPECT_EQ(refused, 0);
  remove_segment(key);
}

TEST(SharedSegment, PagesArePresentBeforeTheTickComes) {
  const auto sut = SharedSegment::make(options_of(own_key(), kMaxSegmentBytes));
  ASSERT_TRUE(sut) << sut.error().text();
  const std::span<std::byte> memory = (*sut)->memory();
  rusage before{};
  rusage after{};
  ::getrusage(RUSAGE_THREAD, &before);
  for (std::size_t i = 0; i < memory.size(); i += 512) memory[i] = std::byte{1};
  ::getrusage(RUSAGE_THREAD, &after);
  EXPECT_LE(after.ru_minflt - before.ru_minflt, 2) << "of 256 pages; one or two may be the program's own";
}

TEST(SharedSegment, RemovedUnderUsIsSeenAndRenewedAtTheSamePlace) {
  const std::int32_t key = own_key();
  const auto sut = SharedSegment::make(options_of(key));
  ASSERT_TRUE(sut);
  const std::span<std::byte> memory = (*sut)->memory();
  ASSERT_TRUE((*sut)->renew());
  EXPECT_EQ((*sut)->renewed(), 0u) << "nothing to do";
  const auto device = AttachedSegment::attach(key, 512, false);
  ASSERT_TRUE(device);
  memory[0] = std::byte{1};

  remove_segment(key);
  EXPECT_TRUE((*sut)->users().gone);
  EXPECT_TRUE(device->removed());
  ASSERT_TRUE((*sut)->renew());
  EXPECT_EQ((*sut)->renewed(), 1u);
  EXPECT_FALSE((*sut)->users().gone);
  EXPECT_EQ((*sut)->memory().data(), memory.data());
  EXPECT_TRUE(all_zero(memory));
  EXPECT_EQ(device->memory()[0], std::byte{1}) << "the device has the old one until it lets go";
  const auto again = AttachedSegment::attach(key, 512, false);
  ASSERT_TRUE(again);
  again->memory()[3] = std::byte{9};
  EXPECT_EQ(memory[3], std::byte{9});
}

TEST(SharedSegment, IsRenewedUnderATickThatGoesOn) {
  const std::int32_t key = own_key();
  const auto sut = SharedSegment::make(options_of(key));
  ASSERT_TRUE(sut);
  std::atomic<bool> over{false};
  std::atomic<std::uint64_t> ticks{0};
  std::thread tick([&] {
    std::atomic_ref<std::uint64_t> word(*reinterpret_cast<std::uint64_t*>((*sut)->memory().data()));
    while (!over.load(std::memory_order_relaxed)) {
      word.store(ticks.fetch_add(1) + 1, std::memory_order_relaxed);
    }
  });
  for (int i = 0; i < 200; ++i) {
    remove_segment(key);
    ASSERT_TRUE((*sut)->renew());
  }
  const std::uint64_t reached = ticks.load();
  while (ticks.load() < reached + 1000) std::this_thread::yield();
  const auto device = AttachedSegment::attach(key, 8, true);
  ASSERT_TRUE(device);
  EXPECT_FALSE(all_zero(device->memory())) << "the tick writes into the memory that the key names";
  over = true;
  tick.join();
  EXPECT_EQ((*sut)->renewed(), 200u);
}

TEST(SharedSegment, RenewalThatIsRefusedLeavesTheOldMemory) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: only root can make one of another user";
  const std::int32_t key = own_key();
  const auto sut = SharedSegment::make(options_of(key));
  ASSERT_TRUE(sut);
  (*sut)->memory()[1] = std::byte{4};
  remove_segment(key);
  ASSERT_EQ(in_child([&] {
              return ::setresuid(kNobody, kNobody, kNobody) == 0 && make_segment(key, 512, 0600) >= 0 ? 0 : 1;
            }),
            0);
  const auto renewed = (*sut)->renew();
  ASSERT_FALSE(renewed);
  EXPECT_NE(renewed.error().what.find("another user"), std::string::npos) << renewed.error().text();
  EXPECT_EQ((*sut)->memory()[1], std::byte{4});
  EXPECT_TRUE((*sut)->users().gone);
  remove_segment(key);
  EXPECT_TRUE((*sut)->renew()) << "when that one is gone";
}

TEST(AttachedSegment, IsRefusedWhereNoneIsThereOrItIsTooSmall) {
  const std::int32_t key = own_key();
  const auto none = AttachedSegment::attach(key, 512, false);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("does not exist"), std::string::npos) << none.error().text();
  const auto segment = SharedSegment::make(options_of(key, 12));
  const auto small = AttachedSegment::attach(key, 512, false);
  ASSERT_FALSE(small);
  EXPECT_NE(small.error().what.find("has 12 bytes, but 512 are needed"), std::string::npos) << small.error().text();
}

TEST(AttachedSegment, SharesTheMemoryUntilItsMakerRemovesIt) {
  const std::int32_t key = own_key();
  auto segment = SharedSegment::make(options_of(key));
  auto attached = AttachedSegment::attach(key, 512, true);
  ASSERT_TRUE(attached);
  EXPECT_FALSE(attached->removed());
  EXPECT_EQ((*segment)->users().attached, 2u);
  (*segment)->memory()[9] = std::byte{3};
  AttachedSegment sut = std::move(*attached);
  EXPECT_EQ(sut.memory()[9], std::byte{3});
  segment->reset();
  EXPECT_TRUE(sut.removed());
  EXPECT_EQ(sut.memory()[9], std::byte{3});
  EXPECT_FALSE(AttachedSegment::attach(key, 512, true));
}

}  // namespace
}  // namespace cellmirror
