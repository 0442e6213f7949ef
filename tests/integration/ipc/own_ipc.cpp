#include "tests/integration/ipc/own_ipc.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/unit/ipc/temporary_folder.hpp"

namespace cellmirror::test {
namespace {

bool in_own_namespace = false;

class OwnIpc : public ::testing::Environment {
 public:
  void SetUp() override {
    in_own_namespace = enter_own_ipc_namespace();
    if (!in_own_namespace) std::puts("no IPC namespace of our own: unique keys in the machine's");
  }
  void TearDown() override {
    if (in_own_namespace) {
      EXPECT_EQ(objects_in_namespace(), 0) << "queues, semaphores or memories were left behind";
    }
  }

 private:
  PrivateRuntimeFolder runtime_folder_;
};

[[maybe_unused]] const auto* const kEnvironment = ::testing::AddGlobalTestEnvironment(new OwnIpc);

}  // namespace

bool enter_own_ipc_namespace() { return ::unshare(CLONE_NEWIPC) == 0; }

QueueConfig own_queues() {
  static std::int32_t next = 0x7100'0000 + (::getpid() % 0x10000) * 64;
  QueueConfig queues;
  queues.script_key = next;
  queues.sensor_key = next + 1;
  queues.reply_key = next + 2;
  next += 3;
  return queues;
}

bool queue_exists(std::int32_t key) { return ::msgget(key, 0) >= 0 || errno != ENOENT; }

void remove_queue(std::int32_t key) {
  const int id = ::msgget(key, 0);
  if (id >= 0) ::msgctl(id, IPC_RMID, nullptr);
}

int make_queue(std::int32_t key, int mode) { return ::msgget(key, IPC_CREAT | IPC_EXCL | mode); }

void remove_semaphore(std::int32_t key) {
  const int id = ::semget(key, 1, 0);
  if (id >= 0) ::semctl(id, 0, IPC_RMID);
}

int objects_in_namespace() {
  int objects = 0;
  for (const char* table : {"/proc/sysvipc/msg", "/proc/sysvipc/sem", "/proc/sysvipc/shm"}) {
    std::ifstream in(table);
    --objects;  // the heading
    for (std::string line; std::getline(in, line);) ++objects;
  }
  return objects;
}

}  // namespace cellmirror::test
