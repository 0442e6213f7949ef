#include "ipc/sysv/force_guard.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <new>
#include <span>

#include "ipc/runtime/system_error.hpp"
#include "ipc/wire/haptic_block.hpp"
#include "ipc/wire/tcp_force_block.hpp"

namespace cellmirror {

// Each place: the segment's number in the lower half, GuardedBlock in the upper one; 0: free.
struct ForceGuard::List {
  std::array<std::atomic<std::uint64_t>, kMostBlocks> places{};
};

namespace {

static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "two processes share it");

std::uint64_t place_of(int segment, GuardedBlock block) {
  return static_cast<std::uint32_t>(segment) | static_cast<std::uint64_t>(block) << 32;
}

// What follows is the guard's own: calls that are safe after fork(), and no heap.

// A next gateway may have taken the memory over meanwhile: what that one writes is left alone. A memory without room
// for the writer's number always had zero forces.
void remove_forces(std::span<std::byte> memory, GuardedBlock block, std::uint32_t gateway) {
  if (block == GuardedBlock::haptic) {
    const bool has_number = memory.size() >= haptic_block_offset::kSize;
    if (!has_number || haptic_block_gateway(memory) == gateway) end_haptic_block(memory);
  }
  if (block == GuardedBlock::tcp_force && tcp_force_process(memory) == gateway) end_tcp_force(memory);
}

void remove_forces(std::uint64_t place, std::uint32_t gateway) {
  const auto block = static_cast<GuardedBlock>(place >> 32);
  const int segment = static_cast<int>(static_cast<std::uint32_t>(place));
  if (block != GuardedBlock::haptic && block != GuardedBlock::tcp_force) return;
  shmid_ds found{};
  if (::shmctl(segment, IPC_STAT, &found) != 0) return;
  void* address = ::shmat(segment, nullptr, 0);
  if (address == reinterpret_cast<void*>(-1)) return;
  remove_forces({static_cast<std::byte*>(address), found.shm_segsz}, block, gateway);
  ::shmdt(address);
}

// Best effort: a step that is refused leaves the guard with no more than the gateway has.
void drop_privileges() {
  ::prctl(PR_SET_NAME, "force-guard");
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  ::prctl(PR_SET_DUMPABLE, 0);
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> none{};
  ::syscall(SYS_capset, &header, none.data());
  const rlimit zero{0, 0};
  ::setrlimit(RLIMIT_FSIZE, &zero);
  ::setrlimit(RLIMIT_NPROC, &zero);
  ::setrlimit(RLIMIT_CORE, &zero);
  if (::chdir("/") != 0) return;
}

void ignore_signals() {
  sigset_t all;
  sigfillset(&all);
  ::sigprocmask(SIG_SETMASK, &all, nullptr);
}

// Only `pipe` stays open, as descriptor 0.
bool close_files(int pipe) {
  if (pipe != STDIN_FILENO && ::dup2(pipe, STDIN_FILENO) < 0) return false;
  return ::close_range(STDIN_FILENO + 1, ~0U, 0) == 0;
}

void wait_for_end_of_file() {
  char byte = 0;
  for (;;) {
    const ssize_t got = ::read(STDIN_FILENO, &byte, 1);
    if (got == 0 || (got < 0 && errno != EINTR)) return;
  }
}

}  // namespace

Result<std::unique_ptr<ForceGuard>> ForceGuard::start() {
  const auto failed = [](const char* what) {
    return fail(
        fmt::format("no guard of the forces in shared memory can be started ({}: {})", what, system_error_text(errno)),
        "raise the limits of processes and memory");
  };
  void* page = ::mmap(nullptr, sizeof(List), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED) return failed("mmap");
  auto* list = new (page) List;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    ::munmap(page, sizeof(List));
    return failed("pipe");
  }
  Descriptor reading(ends[0]);
  Descriptor writing(ends[1]);
  const auto gateway = static_cast<std::uint32_t>(::getpid());
  const pid_t child = ::fork();
  if (child < 0) {
    ::munmap(page, sizeof(List));
    return failed("fork");
  }
  if (child == 0) {
    ignore_signals();
    ::setsid();
    drop_privileges();
    // With the gateway's end of the pipe still open here, its death would not be noticed.
    if (!close_files(reading.get())) ::_exit(1);
    wait_for_end_of_file();
    for (const auto& place : list->places) remove_forces(place.load(std::memory_order_acquire), gateway);
    ::_exit(0);
  }
  return std::unique_ptr<ForceGuard>(new ForceGuard(list, std::move(writing), child));
}

ForceGuard::ForceGuard(List* list, Descriptor pipe, pid_t process)
    : list_(list), pipe_(std::move(pipe)), process_(process) {}

ForceGuard::~ForceGuard() {
  pipe_.reset();
  if (!ended_) {
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  ::munmap(list_, sizeof(List));
}

// Only this process writes the list; the guard reads it when there are no other writers any more.
bool ForceGuard::watch(int segment, GuardedBlock block) {
  const std::scoped_lock lock(mutex_);
  const auto free = std::ranges::find_if(list_->places, [](const auto& place) { return place.load() == 0; });
  if (free == list_->places.end()) return false;
  free->store(place_of(segment, block), std::memory_order_release);
  return true;
}

void ForceGuard::forget(int segment) {
  const std::scoped_lock lock(mutex_);
  for (std::atomic<std::uint64_t>& place : list_->places) {
    const std::uint64_t value = place.load();
    if (value != 0 && static_cast<std::uint32_t>(value) == static_cast<std::uint32_t>(segment)) place.store(0);
  }
}

bool ForceGuard::running() {
  const std::scoped_lock lock(mutex_);
  if (!ended_) ended_ = ::waitpid(process_, nullptr, WNOHANG) != 0;
  return !ended_;
}

}  // namespace cellmirror
