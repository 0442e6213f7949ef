#include "ipc/runtime/ipc_owner.hpp"

#include <gtest/gtest.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <unistd.h>

#include <string>

namespace cellmirror {
namespace {

constexpr const char* kQueues =
    "       key      msqid perms      cbytes       qnum lspid lrpid   uid   gid  cuid  cgid      stime      rtime      "
    "ctime\n"
    "      2351          3   600           0          0     0     0  1001  1001  1002  1002          0          0 "
    "1795420800\n"
    "-1157627904      32770   666          10          1     7     8     0     0     0     0          0          0 "
    "1795420800\n";
constexpr const char* kSemaphores =
    "       key      semid perms      nsems   uid   gid  cuid  cgid      otime      ctime\n"
    "      2351          9   600          1  1003  1003  1004  1004          0 1795420800\n";

TEST(IpcOwner, IsReadFromTheKernelsTable) {
  const auto queue = find_ipc_owner(kQueues, IpcKind::queue, 2351);
  ASSERT_TRUE(queue);
  EXPECT_EQ(queue->id, 3);
  EXPECT_EQ(queue->owner, 1001U);
  EXPECT_EQ(queue->creator, 1002U);
  const auto negative = find_ipc_owner(kQueues, IpcKind::queue, -1157627904);
  ASSERT_TRUE(negative);
  EXPECT_EQ(negative->id, 32770);
  const auto semaphore = find_ipc_owner(kSemaphores, IpcKind::semaphore, 2351);
  ASSERT_TRUE(semaphore);
  EXPECT_EQ(semaphore->creator, 1004U);
  EXPECT_FALSE(find_ipc_owner(kQueues, IpcKind::queue, 2352));
}

TEST(IpcOwner, NoiseIsNoOwner) {
  for (const char* text : {"", "\n", "key\n2351", "key\n2351 x 600 0 0 0 0 1 1 1 1\n", "key\n2351 3 600 0 0 0 0 -\n"})
    EXPECT_FALSE(find_ipc_owner(text, IpcKind::queue, 2351)) << text;
}

TEST(IpcOwner, OfAQueueOfThisProcess) {
  const key_t key = 0x43600000 + (::getpid() & 0xfffff);
  const int made = ::msgget(key, IPC_CREAT | IPC_EXCL | 0600);
  ASSERT_GE(made, 0);
  const auto found = ipc_owner(IpcKind::queue, key);
  ::msgctl(made, IPC_RMID, nullptr);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->id, made);
  EXPECT_EQ(found->creator, ::geteuid());
  EXPECT_FALSE(ipc_owner(IpcKind::queue, key));
}

TEST(IpcOwner, Texts) {
  EXPECT_EQ(user_text(0), "user root (uid 0)");
  EXPECT_EQ(user_text(3'999'999'999U), "uid 3999999999");
  EXPECT_EQ(remove_command(IpcKind::queue, 3), "ipcrm -q 3");
  EXPECT_EQ(remove_command(IpcKind::memory, 4), "ipcrm -m 4");
  EXPECT_EQ(remove_command(IpcKind::semaphore, 5), "ipcrm -s 5");
}

}  // namespace
}  // namespace cellmirror
