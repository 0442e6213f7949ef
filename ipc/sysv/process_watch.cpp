#include "ipc/sysv/process_watch.hpp"

#include <signal.h>

#include <cerrno>
#include <limits>

namespace cellmirror {

bool process_exists(std::uint32_t process) {
  // 0 and negative numbers would mean groups of processes.
  if (process == 0 || process > static_cast<std::uint32_t>(std::numeric_limits<pid_t>::max())) return false;
  return ::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM;
}

bool ProcessWatch::has_ended(std::uint32_t process) {
  if (process == 0) return false;
  const bool there = process_exists(process);
  if (there) seen_ = process;
  return !there && seen_ == process;
}

}  // namespace cellmirror
