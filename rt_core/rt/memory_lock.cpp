#include "rt_core/rt/memory_lock.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace cellmirror {

namespace {

constexpr const char* kRemedy =
    "run as root, or give the program CAP_IPC_LOCK (setcap cap_sys_nice,cap_ipc_lock+ep PROGRAM), or let the user have "
    "it: 'memlock unlimited' in /etc/security/limits.d/ (LimitMEMLOCK=infinity in a systemd unit)";

std::uint64_t page_size() { return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)); }

std::uint64_t mapped_bytes() {
  std::ifstream statm("/proc/self/statm");  // first field: total program size in pages, proc(5)
  std::uint64_t pages = 0;
  statm >> pages;
  return pages * page_size();
}

// RLIMIT_MEMLOCK in force, without limit: none. With `raise`, the soft limit is first raised to the hard one, which
// needs no privilege.
std::optional<std::uint64_t> memlock_limit(bool raise) {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0) {
    return 0;
  }
  if (raise && limit.rlim_cur != limit.rlim_max) {
    rlimit raised = limit;
    raised.rlim_cur = limit.rlim_max;
    if (setrlimit(RLIMIT_MEMLOCK, &raised) == 0) {
      limit = raised;
    }
  }
  const rlim_t in_force = raise ? limit.rlim_cur : limit.rlim_max;
  if (in_force == RLIM_INFINITY) {
    return std::nullopt;
  }
  return in_force;
}

// Whether the kernel holds this process to `limit`. Asked of the kernel itself, because a capability that
// /proc/self/status shows is worth nothing within a user namespace: a locked mapping of one page more than the limit
// (without access, so that it takes no memory) is refused exactly where later mappings would be.
bool limit_binds(std::uint64_t limit) {
  const std::uint64_t size = (limit / page_size() + 1) * page_size();
  void* probe = mmap(nullptr, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_LOCKED, -1, 0);
  if (probe == MAP_FAILED) {
    return true;
  }
  munmap(probe, size);
  return false;
}

// Fills in what is known before anything is locked: `level` says what will be tried.
MemoryLockOutcome examine(bool raise) {
  MemoryLockOutcome outcome;
  outcome.mapped_bytes = mapped_bytes();
  outcome.limit_bytes = memlock_limit(raise);
  if (outcome.limit_bytes && !limit_binds(*outcome.limit_bytes)) {
    outcome.limit_bytes.reset();
  }
  if (!outcome.limit_bytes) {
    outcome.level = MemoryLockLevel::all;
    outcome.ok = true;
    return outcome;
  }
  outcome.remedy = kRemedy;
  const std::uint64_t limit_kib = *outcome.limit_bytes / 1024;
  const std::uint64_t mapped_kib = outcome.mapped_bytes / 1024;
  if (outcome.mapped_bytes <= *outcome.limit_bytes) {
    outcome.level = MemoryLockLevel::current;
    outcome.why_not = fmt::format(
        "only the memory mapped at the start ({} KiB) can be locked: RLIMIT_MEMLOCK is {} KiB, and with it later "
        "memory would be refused instead of locked",
        mapped_kib, limit_kib);
  } else {
    outcome.why_not = fmt::format("memory cannot be locked: the process maps {} KiB, RLIMIT_MEMLOCK is {} KiB",
                                  mapped_kib, limit_kib);
  }
  return outcome;
}

void failed(MemoryLockOutcome& outcome, MemoryLockLevel reached, int error) {
  outcome.level = reached;
  outcome.ok = false;
  outcome.why_not = fmt::format("memory cannot be locked: mlockall: {}", std::strerror(error));
  outcome.remedy = kRemedy;
}

// Freed memory stays with the process, and large blocks come from the heap instead of mappings of their own: neither
// gives page faults again for memory that was already touched.
void keep_malloc_from_giving_back() {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
}

}  // namespace

MemoryLockOutcome lock_memory(RealTimePolicy policy) {
  if (policy == RealTimePolicy::off) {
    MemoryLockOutcome outcome;
    outcome.ok = true;
    outcome.limit_bytes = memlock_limit(false);
    outcome.mapped_bytes = mapped_bytes();
    return outcome;
  }
  keep_malloc_from_giving_back();
  MemoryLockOutcome outcome = examine(true);
  if (outcome.level == MemoryLockLevel::none) {
    return outcome;
  }
  if (mlockall(MCL_CURRENT) != 0) {
    failed(outcome, MemoryLockLevel::none, errno);
    return outcome;
  }
  // A second call: together with MCL_CURRENT, MCL_ONFAULT would keep the first from reading everything in.
  if (outcome.level == MemoryLockLevel::all && mlockall(MCL_FUTURE | MCL_ONFAULT) != 0) {
    failed(outcome, MemoryLockLevel::current, errno);
  }
  return outcome;
}

Result<void> enforce(RealTimePolicy policy, const MemoryLockOutcome& outcome) {
  if (policy == RealTimePolicy::require && !outcome.ok) {
    return fail("locked memory is required: " + outcome.why_not, outcome.remedy);
  }
  return {};
}

MemoryLockOutcome probe_memory_lock() { return examine(false); }

[[gnu::noinline]] void prefault_stack(std::size_t bytes) {
  const std::size_t size = std::clamp<std::size_t>(bytes, 1, kMostStackPrefault);
  volatile auto* stack = static_cast<volatile unsigned char*>(__builtin_alloca(size));
  constexpr std::size_t kSmallestPage = 4096;
  for (std::size_t i = 0; i < size; i += kSmallestPage) {
    stack[i] = 0;
  }
  stack[size - 1] = 0;
}

CpuLatencyRequest::CpuLatencyRequest(std::int32_t microseconds) {
  // Documentation/power/pm_qos_interface.rst of the kernel: the request holds while the file is open.
  descriptor_ = Descriptor(open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC));
  if (descriptor_.valid()) {
    if (write(descriptor_.get(), &microseconds, sizeof(microseconds)) == sizeof(microseconds)) {
      return;
    }
    const int error = errno;
    descriptor_.reset();
    why_not_ = fmt::format("/dev/cpu_dma_latency took no request: {}", std::strerror(error));
    return;
  }
  why_not_ = fmt::format("/dev/cpu_dma_latency cannot be opened: {}", std::strerror(errno));
  remedy_ = errno == ENOENT ? "none on this machine (a container or a kernel without power management)"
                            : "run as root, or let a udev rule give the user's group write access to it";
}

}  // namespace cellmirror
