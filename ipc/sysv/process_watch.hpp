// Whether a process that calls itself by a number has ended.
#pragma once

#include <cstdint>

namespace cellmirror {

// Whether this machine has such a process, as far as this process's PID namespace shows. A number from shared memory is
// only used in this query. A system call: not for the tick.
[[nodiscard]] bool process_exists(std::uint32_t process);

// Called regularly with the number that a peer wrote into shared memory. The number of a peer in another PID namespace
// (a container) has no meaning here: its end is never reported, only the age of its data counts. One thread.
class ProcessWatch {
 public:
  // True if the process existed at an earlier call and no longer exists. 0: none, false. System calls.
  [[nodiscard]] bool has_ended(std::uint32_t process);

 private:
  std::uint32_t seen_ = 0;  // that existed at the first call
};

}  // namespace cellmirror
