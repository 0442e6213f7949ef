// The scheduling of threads: what was asked of the operating system, and what it gave.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// The outcome of asking for real-time scheduling, or the state of a thread. Data for `status` and `doctor`.
struct SchedulingOutcome {
  std::string scheduler = "unknown";  // "SCHED_FIFO", "SCHED_RR", "SCHED_OTHER", ...: what is in force now
  int priority = 0;                   // 1..99 for SCHED_FIFO and SCHED_RR, else 0
  bool ok = false;                    // what was asked for is in force (always so with RealTimePolicy::off)
  std::string why_not;                // empty where ok
  std::string remedy;                 // commands or settings that correct it; empty where ok
};

// Gives the calling thread SCHED_FIFO at `priority` (1..99), unless the policy is `off`: then nothing is changed. Any
// failure is in the outcome. Not for the tick: the thread calls it before its loop.
[[nodiscard]] SchedulingOutcome set_real_time_scheduling(RealTimePolicy policy, int priority);
// What is in force for the calling thread; ok is true.
[[nodiscard]] SchedulingOutcome current_scheduling();
// What set_real_time_scheduling(prefer, priority) would give, found out on a thread that ends again. For `doctor`.
[[nodiscard]] SchedulingOutcome probe_real_time_scheduling(int priority);
// A failure where `policy` is `require` and the outcome is not ok.
[[nodiscard]] Result<void> enforce(RealTimePolicy policy, const SchedulingOutcome& outcome);

// Lets the calling thread, of the ordinary class, go before other ordinary threads with work of less than a
// millisecond: it asks for short time slices, for which Linux (from 6.12 on) lets it run soon after it wakes, and for
// nice -10. True where the system gave the second, too, for which it wants CAP_SYS_NICE or LimitNICE. Real-time threads
// go before it.
bool prefer_short_work();

// Binds the calling thread to one processor (from 0).
[[nodiscard]] Result<void> set_cpu_affinity(int cpu);
// The name of the calling thread in top, ps and debuggers; the kernel keeps 15 bytes, the rest is cut.
void set_thread_name(std::string_view name);
// The kernel's id of the calling thread, as in /proc/self/task.
[[nodiscard]] pid_t thread_id();

}  // namespace cellmirror
