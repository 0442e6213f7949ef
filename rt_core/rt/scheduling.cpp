#include "rt_core/rt/scheduling.hpp"

#include <fmt/core.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <thread>

namespace cellmirror {

namespace {

std::string scheduler_name(int policy) {
  switch (policy) {
    case SCHED_FIFO:
      return "SCHED_FIFO";
    case SCHED_RR:
      return "SCHED_RR";
    case SCHED_OTHER:
      return "SCHED_OTHER";
    case SCHED_BATCH:
      return "SCHED_BATCH";
    case SCHED_IDLE:
      return "SCHED_IDLE";
    default:
      return fmt::format("policy {}", policy);
  }
}

// As sched_setattr(2) takes it; the C library has no declaration.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = SCHED_OTHER;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t slice_ns = 0;  // sched_runtime; of the ordinary class: the length of a time slice
  std::uint64_t deadline_ns = 0;
  std::uint64_t period_ns = 0;
};

bool set_attributes(const SchedulingAttributes& attributes) {
  constexpr unsigned kNoFlags = 0;
  return syscall(SYS_sched_setattr, 0, &attributes, kNoFlags) == 0;
}

// What the user can do about EPERM.
std::string permission_remedy(int priority) {
  return fmt::format(
      "run as root, or give the program CAP_SYS_NICE (setcap cap_sys_nice,cap_ipc_lock+ep PROGRAM), or let the user "
      "have it: 'rtprio {}' in /etc/security/limits.d/ (LimitRTPRIO={} in a systemd unit)",
      priority, priority);
}

}  // namespace

SchedulingOutcome current_scheduling() {
  SchedulingOutcome outcome;
  sched_param parameters{};
  int policy = SCHED_OTHER;
  // pthread functions return the error, they do not set errno.
  if (const int error = pthread_getschedparam(pthread_self(), &policy, &parameters); error != 0) {
    outcome.why_not = fmt::format("the scheduling of the thread cannot be read: {}", std::strerror(error));
    return outcome;
  }
  outcome.scheduler = scheduler_name(policy);
  outcome.priority = parameters.sched_priority;
  outcome.ok = true;
  return outcome;
}

SchedulingOutcome set_real_time_scheduling(RealTimePolicy policy, int priority) {
  if (policy == RealTimePolicy::off) {
    return current_scheduling();
  }
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  SchedulingOutcome outcome = current_scheduling();
  if (error == 0) {
    return outcome;
  }
  outcome.ok = false;
  outcome.why_not = fmt::format("SCHED_FIFO priority {} was refused: {}", priority, std::strerror(error));
  if (error == EPERM) {
    outcome.remedy = permission_remedy(priority);
  } else if (error == EINVAL) {
    outcome.remedy = fmt::format("choose a priority from {} to {}", sched_get_priority_min(SCHED_FIFO),
                                 sched_get_priority_max(SCHED_FIFO));
  } else {
    outcome.remedy = "run the gateway on a machine (or container) that allows real-time scheduling, or without it";
  }
  return outcome;
}

SchedulingOutcome probe_real_time_scheduling(int priority) {
  SchedulingOutcome outcome;
  std::thread([&] { outcome = set_real_time_scheduling(RealTimePolicy::prefer, priority); }).join();
  return outcome;
}

Result<void> enforce(RealTimePolicy policy, const SchedulingOutcome& outcome) {
  if (policy == RealTimePolicy::require && !outcome.ok) {
    return fail("real-time scheduling is required: " + outcome.why_not, outcome.remedy);
  }
  return {};
}

bool prefer_short_work() {
  constexpr std::int32_t kNice = -10;
  constexpr std::uint64_t kSlice_ns = 100'000;  // the shortest that Linux takes
  if (set_attributes({.nice = kNice, .slice_ns = kSlice_ns})) return true;
  static_cast<void>(set_attributes({.slice_ns = kSlice_ns}));
  return false;
}

Result<void> set_cpu_affinity(int cpu) {
  if (cpu < 0 || cpu >= CPU_SETSIZE) {
    return fail(fmt::format("there is no processor {}", cpu), "processors are numbered from 0; see nproc");
  }
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  if (const int error = pthread_setaffinity_np(pthread_self(), sizeof(set), &set); error != 0) {
    return fail(fmt::format("the thread cannot be bound to processor {}: {}", cpu, std::strerror(error)),
                "choose one of those that `taskset -p $$` shows, counted from 0");
  }
  return {};
}

void set_thread_name(std::string_view name) {
  constexpr std::size_t kMost = 15;  // the kernel's limit (TASK_COMM_LEN - 1); a longer name would be refused
  const std::string cut(name.substr(0, kMost));
  static_cast<void>(pthread_setname_np(pthread_self(), cut.c_str()));
}

pid_t thread_id() { return gettid(); }

}  // namespace cellmirror
