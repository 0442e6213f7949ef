// An IPC namespace of the test program's own where that is allowed, keys of its own in any case, and a runtime folder
// of its own; queues, semaphores and memories that are left at the end are a failure.
#pragma once

#include <cstdint>
#include <filesystem>

#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::test {

// Enters it for the whole program, before any thread is made. False where the machine does not allow it.
bool enter_own_ipc_namespace();

// Three keys that no other test or program uses at this time: unique for process and call.
QueueConfig own_queues();

// Whether a queue with this key exists.
bool queue_exists(std::int32_t key);
// Removes it, if it exists.
void remove_queue(std::int32_t key);
// Makes one, as a program that knows nothing of cellmirror would. Returns its id.
int make_queue(std::int32_t key, int mode);
// Removes the semaphore of a key, if it exists.
void remove_semaphore(std::int32_t key);
// All queues, semaphores and memories of the namespace; meaningful only in one's own.
int objects_in_namespace();

}  // namespace cellmirror::test
