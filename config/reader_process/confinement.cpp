#include "config/reader_process/confinement.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror {

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

void limit(__rlimit_resource resource, rlim_t most, rlim_t beyond = 0) {
  const rlimit both{most, most + beyond};
  setrlimit(resource, &both);
}

// Where memory runs out the kernel ends this process first.
void be_ended_first() {
  const Descriptor file(open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC));
  if (!file.valid()) return;
  [[maybe_unused]] const ssize_t written = write(file.get(), "1000", 4);
}

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;  // not known: system calls stay free
#endif

// Others fail with EPERM: what is harmless and merely new in a later C library does not end the process.
void allow_few_system_calls() {
  static constexpr std::array kAllowed{
      __NR_read,         __NR_write,     __NR_brk,   __NR_mmap,         __NR_munmap,         __NR_mremap,
      __NR_mprotect,     __NR_madvise,   __NR_futex, __NR_rt_sigreturn, __NR_rt_sigprocmask, __NR_clock_gettime,
      __NR_gettimeofday, __NR_getrandom, __NR_exit,  __NR_exit_group};
  constexpr std::uint32_t kLoad = BPF_LD | BPF_W | BPF_ABS;
  constexpr std::uint32_t kIfEqual = BPF_JMP | BPF_JEQ | BPF_K;
  constexpr std::uint32_t kReturn = BPF_RET | BPF_K;
  constexpr std::size_t kBefore = 4;
  std::array<sock_filter, kBefore + kAllowed.size() + 2> program{};
  program[0] = BPF_STMT(kLoad, offsetof(seccomp_data, arch));
  program[1] = BPF_JUMP(kIfEqual, kMachine, 1, 0);
  program[2] = BPF_STMT(kReturn, SECCOMP_RET_KILL_PROCESS);
  program[3] = BPF_STMT(kLoad, offsetof(seccomp_data, nr));
  for (std::size_t i = 0; i < kAllowed.size(); ++i) {
    // To the last line, past what is left of the list and the refusal.
    const auto to_the_end = static_cast<std::uint8_t>(kAllowed.size() - i);
    program[kBefore + i] = BPF_JUMP(kIfEqual, static_cast<std::uint32_t>(kAllowed[i]), to_the_end, 0);
  }
  constexpr std::uint32_t kNotPermitted = 1;
  program[program.size() - 2] = BPF_STMT(kReturn, SECCOMP_RET_ERRNO | kNotPermitted);
  program[program.size() - 1] = BPF_STMT(kReturn, SECCOMP_RET_ALLOW);
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter);
}

}  // namespace

void confine_this_process(const Confinement& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  be_ended_first();
  close_range(3, ~0U, 0);
  prctl(PR_SET_DUMPABLE, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, limits.processor_seconds, 1);  // SIGXCPU at the first, SIGKILL at the second
  if (kSanitized) return;
  limit(RLIMIT_NOFILE, 3);
  limit(RLIMIT_AS, limits.address_space_bytes);
  if (kMachine != 0) allow_few_system_calls();
}

}  // namespace cellmirror
