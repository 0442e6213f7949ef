// Common process functions of simulators: termination by signals, scheduling.
#pragma once

namespace cellmirror::sim {

// SIGINT and SIGTERM are noted from here on.
void install_signal_handlers();
[[nodiscard]] bool signalled();

// The calling thread: no timer slack, and SCHED_FIFO where `priority` > 0. False where that was not granted.
[[nodiscard]] bool become_punctual(int priority);

}  // namespace cellmirror::sim
