// What the gateway needs of the limits of a process (setrlimit(2)), and what it says where they are reached.
#pragma once

#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// Raises the soft limit of open files as far as the gateway needs and the hard one allows. Refused, with the command
// that raises it: a limit of open files or of address space (ulimit -v) with which the gateway cannot start.
[[nodiscard]] Result<void> check_resource_limits();

// Where memory, files or threads run out in any thread later on, the program ends with what ran out and how to raise
// it, and not as if it had a bug. Once, before other threads are started.
void report_exhausted_resources();

}  // namespace cellmirror::app
