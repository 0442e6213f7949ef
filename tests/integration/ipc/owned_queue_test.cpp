#include "ipc/sysv/owned_queue.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/msg.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>

#include "tests/integration/ipc/own_ipc.hpp"
#include "tests/unit/ipc/temporary_folder.hpp"

namespace cellmirror {
namespace {

using test::make_queue;
using test::own_queues;
using test::queue_exists;
using test::remove_queue;
using test::remove_semaphore;

OwnedQueue::Options options_of(std::int32_t key) { return {"test", key, 0600, "test"}; }

std::span<const char> span_of(std::string_view text) { return {text.data(), text.size()}; }

TEST(OwnedQueue, IsMadeWithItsModeAndRemoved) {
  const std::int32_t key = own_queues().script_key;
  {
    const auto sut = OwnedQueue::make(options_of(key));
    ASSERT_TRUE(sut) << sut.error().text();
    msqid_ds found{};
    ASSERT_EQ(::msgctl(::msgget(key, 0), IPC_STAT, &found), 0);
    EXPECT_EQ(found.msg_perm.mode & 0777u, 0600u);
  }
  EXPECT_FALSE(queue_exists(key));
}

TEST(OwnedQueue, SecondOwnerIsRefusedWithTheProcess) {
  const std::int32_t key = own_queues().script_key;
  const auto first = OwnedQueue::make(options_of(key));
  ASSERT_TRUE(first);
  const auto sut = OwnedQueue::make(options_of(key));
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("process " + std::to_string(::getpid())), std::string::npos) << sut.error().text();
  EXPECT_NE(sut.error().what.find("instance test"), std::string::npos);
  EXPECT_NE(sut.error().remedy.find("--instance"), std::string::npos);
  EXPECT_TRUE(queue_exists(key)) << "the refused one must not remove the first one's queue";
}

TEST(OwnedQueue, WhatAKilledProcessLeftBehindIsMadeAnew) {
  const std::int32_t key = own_queues().script_key;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    auto queue = OwnedQueue::make(options_of(key));
    const bool ok = queue && (*queue)->send_now(5, span_of("old 1")) == QueueOutcome::done &&
                    (*queue)->send_now(5, span_of("old 2")) == QueueOutcome::done;
    if (::write(ready[1], ok ? "y" : "n", 1) == 1) ::pause();
    _exit(1);
  }
  char ok = 'n';
  ASSERT_EQ(::read(ready[0], &ok, 1), 1);
  ASSERT_EQ(ok, 'y');
  EXPECT_FALSE(OwnedQueue::make(options_of(key))) << "the owner lives";
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(ready[0]);
  ::close(ready[1]);

  ASSERT_TRUE(queue_exists(key));
  const auto sut = OwnedQueue::make(options_of(key));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ((*sut)->discarded(), 2u);
  EXPECT_EQ((*sut)->waiting(), 0u);
}

TEST(OwnedQueue, WiderModeIsRefusedWithTheCommandThatMendsIt) {
  const std::int32_t key = own_queues().script_key;
  ASSERT_GE(make_queue(key, 0666), 0);
  const auto sut = OwnedQueue::make(options_of(key));
  ASSERT_FALSE(sut);
  const std::string command = "ipcrm -q " + std::to_string(::msgget(key, 0));
  EXPECT_NE(sut.error().remedy.find(command), std::string::npos) << sut.error().text();
  EXPECT_NE(sut.error().what.find("666"), std::string::npos);
  EXPECT_TRUE(queue_exists(key)) << "what is refused is not touched";
  OwnedQueue::Options wide = options_of(key);
  wide.mode = 0666;
  EXPECT_TRUE(OwnedQueue::make(wide)) << "the cell file may allow it";
  remove_queue(key);
}

TEST(OwnedQueue, QueueOfAnotherUserIsRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: only root can make a queue of another user";
  const std::int32_t key = own_queues().script_key;
  const pid_t child = ::fork();
  if (child == 0) _exit(::setresuid(65534, 65534, 65534) == 0 && make_queue(key, 0600) >= 0 ? 0 : 1);
  int status = 1;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  const auto sut = OwnedQueue::make(options_of(key));
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("another user"), std::string::npos) << sut.error().text();
  EXPECT_NE(sut.error().what.find("uid 65534"), std::string::npos) << sut.error().text();
  EXPECT_NE(sut.error().remedy.find("ipcrm -q " + std::to_string(::msgget(key, 0))), std::string::npos);
  EXPECT_TRUE(queue_exists(key));
  remove_queue(key);
}

// The same seen by an ordinary user, who may not even look at root's queue.
TEST(OwnedQueue, QueueOfRootIsRefusedToAnOrdinaryUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: only root can become another user";
  const std::int32_t key = own_queues().script_key;
  ASSERT_GE(make_queue(key, 0600), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    if (::setresuid(65534, 65534, 65534) != 0) _exit(2);
    ::setenv("CELLMIRROR_RUNTIME_DIR", ("/tmp/cellmirror-test-nobody-" + std::to_string(::getpid())).c_str(), 1);
    const auto sut = OwnedQueue::make(options_of(key));
    const bool refused = !sut && sut.error().what.find("another user: user root (uid 0)") != std::string::npos;
    std::error_code ignored;
    std::filesystem::remove_all(std::getenv("CELLMIRROR_RUNTIME_DIR"), ignored);
    _exit(refused ? 0 : 1);
  }
  int status = 1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  remove_queue(key);
}

TEST(OwnedQueue, SecondOwnerWithAnotherRuntimeFolderIsRefused) {
  const std::int32_t key = own_queues().script_key;
  const auto first = OwnedQueue::make(options_of(key));
  ASSERT_TRUE(first);
  const test::TemporaryFolder elsewhere;
  const std::string before = std::getenv("CELLMIRROR_RUNTIME_DIR");
  ::setenv("CELLMIRROR_RUNTIME_DIR", elsewhere.path().c_str(), 1);
  const auto sut = OwnedQueue::make(options_of(key));
  ::setenv("CELLMIRROR_RUNTIME_DIR", before.c_str(), 1);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("process " + std::to_string(::getpid())), std::string::npos) << sut.error().text();
  EXPECT_TRUE(queue_exists(key));
}

// As another user's running gateway looks: its semaphore is seen first.
TEST(OwnedQueue, KeyOfAnotherUsersGatewayIsRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: only root can become another user";
  const std::int32_t key = own_queues().script_key;
  const auto first = OwnedQueue::make(options_of(key));
  ASSERT_TRUE(first);
  const pid_t child = ::fork();
  if (child == 0) {
    if (::setresuid(65534, 65534, 65534) != 0) _exit(2);
    const std::string folder = "/tmp/cellmirror-test-nobody-" + std::to_string(::getpid());
    ::setenv("CELLMIRROR_RUNTIME_DIR", folder.c_str(), 1);
    const auto sut = OwnedQueue::make(options_of(key));
    const bool refused =
        !sut && sut.error().what.find("in use by another user: user root (uid 0)") != std::string::npos;
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    _exit(refused ? 0 : 1);
  }
  int status = 1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(OwnedQueue, KeyZeroIsRefused) { EXPECT_FALSE(OwnedQueue::make(options_of(0))); }

TEST(OwnedQueue, ReportsFullAndEmpty) {
  const auto sut = OwnedQueue::make(options_of(own_queues().script_key));
  ASSERT_TRUE(sut);
  EXPECT_EQ((*sut)->discard_oldest(5), QueueOutcome::empty);
  const std::string big(4096, 'x');
  int sent = 0;
  while (sent < 1000 && (*sut)->send_now(5, big) == QueueOutcome::done) ++sent;
  EXPECT_EQ((*sut)->send_now(5, big), QueueOutcome::full);
  EXPECT_EQ((*sut)->waiting(), static_cast<std::uint64_t>(sent));
  EXPECT_EQ((*sut)->discard_oldest(7), QueueOutcome::empty);
  EXPECT_EQ((*sut)->discard_oldest(5), QueueOutcome::done);
  EXPECT_EQ((*sut)->send_now(5, big), QueueOutcome::done);
}

TEST(OwnedQueue, RemovedFromOutsideIsMadeAnew) {
  const std::int32_t key = own_queues().script_key;
  const auto sut = OwnedQueue::make(options_of(key));
  ASSERT_TRUE(sut);
  remove_queue(key);
  EXPECT_EQ((*sut)->send_now(5, span_of("x")), QueueOutcome::gone);
  EXPECT_TRUE((*sut)->recreate());
  EXPECT_EQ((*sut)->send_now(5, span_of("x")), QueueOutcome::done);
  EXPECT_EQ((*sut)->recreated(), 1u);
  EXPECT_TRUE((*sut)->recreate()) << "nothing to do is not a failure";
  EXPECT_EQ((*sut)->recreated(), 1u);
}

TEST(OwnedQueue, IsNotMadeAnewWhereAnotherGatewayGotTheKey) {
  const std::int32_t key = own_queues().script_key;
  const auto sut = OwnedQueue::make(options_of(key));
  ASSERT_TRUE(sut);
  // Log-out: queue and semaphore go, and the folder with the locks.
  remove_queue(key);
  remove_semaphore(key);
  const std::filesystem::path locks = std::filesystem::path(std::getenv("CELLMIRROR_RUNTIME_DIR")) / ".locks";
  std::filesystem::remove_all(locks);
  {
    const auto other = OwnedQueue::make(options_of(key));
    ASSERT_TRUE(other);
    const auto refused = (*sut)->recreate();
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().what.find("in use by process"), std::string::npos) << refused.error().text();
    EXPECT_TRUE(queue_exists(key));
  }
  EXPECT_TRUE((*sut)->recreate()) << "the other one has ended";
}

TEST(OwnedQueue, StaysClosed) {
  const std::int32_t key = own_queues().script_key;
  const auto sut = OwnedQueue::make(options_of(key));
  ASSERT_TRUE(sut);
  (*sut)->close();
  EXPECT_FALSE(queue_exists(key));
  EXPECT_FALSE((*sut)->recreate());
  EXPECT_FALSE(queue_exists(key));
}

}  // namespace
}  // namespace cellmirror
