#include "ipc/sysv/key_semaphore.hpp"

#include <fmt/format.h>
#include <sys/ipc.h>
#include <sys/sem.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <utility>

#include "ipc/runtime/ipc_owner.hpp"
#include "ipc/runtime/system_error.hpp"

namespace cellmirror {
namespace {

// semctl(2): the caller has to define it.
union SemaphoreArgument {
  int value;
  semid_ds* status;
};

std::unexpected<Error> other_users(std::int32_t key) {
  const auto found = ipc_owner(IpcKind::semaphore, key);
  const std::string owner = found ? ": " + user_text(found->creator) : "";
  const std::string command = found ? remove_command(IpcKind::semaphore, found->id) : fmt::format("ipcrm -S {}", key);
  return fail(
      fmt::format("the key {:#x} ({}) is in use by another user{}", static_cast<std::uint32_t>(key), key, owner),
      fmt::format("start this gateway with --instance NAME and keys of its own; if that user's gateway was "
                  "killed, that user or root must run {}",
                  command));
}

bool is_ours(int id) {
  semid_ds found{};
  SemaphoreArgument argument{};
  argument.status = &found;
  return ::semctl(id, 0, IPC_STAT, argument) == 0 && found.sem_perm.uid == ::geteuid() &&
         found.sem_perm.cuid == ::geteuid();
}

// In one step, so that of two gateways one gets it: wait for 0, which may not last, and add 1.
int raise(int id) {
  std::array<sembuf, 2> steps{{{0, 0, IPC_NOWAIT}, {0, 1, SEM_UNDO}}};
  return ::semop(id, steps.data(), steps.size());
}

}  // namespace

Result<KeySemaphore> KeySemaphore::take(std::int32_t key) {
  for (int i = 0; i < 8; ++i) {
    const int id = ::semget(key, 1, IPC_CREAT | 0600);
    if (id < 0) {
      const int reason = errno;
      if (reason == EACCES) return other_users(key);
      return fail(fmt::format("cannot create the semaphore of the key {:#x}: {}", static_cast<std::uint32_t>(key),
                              system_error_text(reason)),
                  reason == ENOSPC ? "remove unused semaphores (ipcs -s, ipcrm -s ID) or raise kernel.sem" : "");
    }
    if (raise(id) == 0) {
      if (is_ours(id)) return KeySemaphore(id);
      // Only root gets here with a semaphore of another user.
      sembuf back{0, -1, SEM_UNDO | IPC_NOWAIT};
      ::semop(id, &back, 1);
      return other_users(key);
    }
    if (errno == EIDRM || errno == EINVAL) continue;  // its holder just ended
    return fail(fmt::format("the key {:#x} ({}) is in use by process {}, a gateway with another runtime folder",
                            static_cast<std::uint32_t>(key), key, ::semctl(id, 0, GETPID)),
                "end that gateway, or start this one with --instance NAME and keys of its own");
  }
  return fail(fmt::format("the semaphore of the key {:#x} is repeatedly removed", static_cast<std::uint32_t>(key)),
              "end the program that removes it, or set other keys in the cell file");
}

KeySemaphore::KeySemaphore(KeySemaphore&& other) noexcept : id_(std::exchange(other.id_, -1)) {}

KeySemaphore& KeySemaphore::operator=(KeySemaphore&& other) noexcept {
  if (this != &other) {
    release();
    id_ = std::exchange(other.id_, -1);
  }
  return *this;
}

KeySemaphore::~KeySemaphore() { release(); }

bool KeySemaphore::in_place() const { return id_ >= 0 && ::semctl(id_, 0, GETVAL) == 1; }

void KeySemaphore::release() {
  if (id_ >= 0) ::semctl(std::exchange(id_, -1), 0, IPC_RMID);
}

bool KeySemaphore::is_held(std::int32_t key) {
  const int id = ::semget(key, 1, 0400);
  return id >= 0 && ::semctl(id, 0, GETVAL) > 0;
}

}  // namespace cellmirror
