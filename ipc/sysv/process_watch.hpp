// Whether a process that calls itself by a number has ended.
#pragma once

#include <cstdint>

namespace cellmirror {

// Whether this machine has such a process, as far as this process's PID namespace shows. A number that comes from
// shared memory is only ever asked about. A system call: not for the tick.
[[nodiscard]] bool process_exists(std::uint32_t process);

// Asked now and then with the number that a peer wrote into shared memory. A peer in another PID namespace (a
// container) has a number that says nothing here: it is never told to have ended, its age has to do. One thread.
class ProcessWatch {
 public:
  // True where the process was there at an earlier look and is no longer. 0: nobody, false. System calls.
  [[nodiscard]] bool has_ended(std::uint32_t process);

 private:
  std::uint32_t seen_ = 0;  // that was there when it was looked at first
};

}  // namespace cellmirror
