// Keeping the process's memory in RAM, so that the tick meets no page fault; and what else keeps a machine awake.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror {

enum class MemoryLockLevel : std::uint8_t {
  none,
  current,  // what was mapped at the time of the call; later memory may be paged out
  all,      // that, and everything mapped later from its first touch on
};

// Data for `status` and `doctor`.
struct MemoryLockOutcome {
  MemoryLockLevel level = MemoryLockLevel::none;
  bool ok = false;                           // `all` was reached, or the policy was `off`
  std::optional<std::uint64_t> limit_bytes;  // RLIMIT_MEMLOCK in force; none: without limit, or not bound by it
  std::uint64_t mapped_bytes = 0;            // of the process at the time of the call
  std::string why_not;                       // empty where ok
  std::string remedy;                        // empty where ok
};

// Locks the process's memory, unless the policy is `off`. Call it once, early, before threads are started (their whole
// stacks count as mapped): everything mapped then is read in and locked; what is mapped later is locked page by page as
// it is first touched (MCL_ONFAULT), so that the reserved but unused parts of thread stacks cost nothing. Memory
// for the tick is therefore written first, which filling it does anyway.
//
// The soft limit is raised to the hard one. Later memory is locked only where no limit binds the process (CAP_IPC_LOCK
// or an unlimited RLIMIT_MEMLOCK): with a small limit the kernel would refuse later mappings and malloc would fail.
// Unless `off`, malloc is also set to keep freed memory and to use no separate mappings. Not for the tick.
[[nodiscard]] MemoryLockOutcome lock_memory(RealTimePolicy policy);
// A failure where `policy` is `require` and the outcome is not ok.
[[nodiscard]] Result<void> enforce(RealTimePolicy policy, const MemoryLockOutcome& outcome);
// Whether a limit binds this process, without locking anything: level is `all` where lock_memory() would reach it. For
// `doctor`.
[[nodiscard]] MemoryLockOutcome probe_memory_lock();

// Touches the calling thread's stack down to `bytes` below the caller, so that the loop finds it mapped. At most
// kMostStackPrefault; the thread's stack must be larger.
inline constexpr std::size_t kStackPrefault = std::size_t{128} * 1024;
inline constexpr std::size_t kMostStackPrefault = std::size_t{512} * 1024;
void prefault_stack(std::size_t bytes = kStackPrefault);

// Keeps the processors out of deep idle states (whose way back costs tens to hundreds of microseconds) for as long as
// it lives, by /dev/cpu_dma_latency. Where that is not allowed or not there, it does nothing and says so.
class CpuLatencyRequest {
 public:
  // Requests a wake-up latency of at most `microseconds`; 0: no idle states.
  explicit CpuLatencyRequest(std::int32_t microseconds);
  CpuLatencyRequest(const CpuLatencyRequest&) = delete;
  CpuLatencyRequest& operator=(const CpuLatencyRequest&) = delete;

  [[nodiscard]] bool ok() const { return descriptor_.valid(); }
  [[nodiscard]] const std::string& why_not() const { return why_not_; }  // empty where ok
  [[nodiscard]] const std::string& remedy() const { return remedy_; }    // empty where ok

 private:
  Descriptor descriptor_;
  std::string why_not_;
  std::string remedy_;
};

}  // namespace cellmirror
