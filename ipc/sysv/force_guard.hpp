// A small process beside the gateway, which removes its forces from shared memory when it dies without doing so itself.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// What a segment holds, and so how its forces are removed. `none`: nothing of the gateway's.
enum class GuardedBlock : std::uint32_t { none, haptic, tcp_force };

// The kernel closes the pipe between the two when the gateway's last thread has ended, however that happened (kill -9,
// a crash). The guard then attaches the segments that are still noted, writes zero forces, phase closed and process 0
// into those that this gateway wrote last, and ends. Until then it has no segment attached, so that the gateway sees
// only its devices. After an ordinary end nothing is noted, and the guard ends at once.
//
// The guard has no privileges, no files but the pipe, its own session (Ctrl-C and signals to the gateway's group do not
// reach it), and ignores all signals that can be. It shares one page with the gateway: the list of segments.
class ForceGuard {
 public:
  static constexpr std::size_t kMostBlocks = 16;

  // Forks: before any other thread is started, any segment attached and memory locked. Fails where the machine has no
  // room for another process.
  static Result<std::unique_ptr<ForceGuard>> start();
  // Waits until the guard has ended.
  ~ForceGuard();
  ForceGuard(const ForceGuard&) = delete;
  ForceGuard& operator=(const ForceGuard&) = delete;

  // Segments by the kernel's number (shmget(2)). Any thread. False: the list is full.
  bool watch(int segment, GuardedBlock block);
  void forget(int segment);

  // False where the guard was ended from outside: nobody removes the forces of a killed gateway then. Any thread; a
  // system call.
  [[nodiscard]] bool running();
  [[nodiscard]] pid_t process() const { return process_; }

 private:
  struct List;
  ForceGuard(List* list, Descriptor pipe, pid_t process);

  List* list_;       // in memory that both processes see
  Descriptor pipe_;  // its end tells the guard that this process has ended
  pid_t process_;
  std::mutex mutex_;  // of writing the list, and what follows
  bool ended_ = false;
};

}  // namespace cellmirror
