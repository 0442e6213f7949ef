// What every simulator's process does: end when it is told to, and be on time.
#pragma once

namespace cellmirror::sim {

// SIGINT and SIGTERM are noted from here on.
void install_signal_handlers();
[[nodiscard]] bool signalled();

// The calling thread: no timer slack, and SCHED_FIFO where `priority` > 0. False where that was not granted.
[[nodiscard]] bool become_punctual(int priority);

}  // namespace cellmirror::sim
