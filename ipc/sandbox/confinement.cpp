#include "ipc/sandbox/confinement.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#include "ipc/sandbox/channel.hpp"
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

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;  // not known: system calls stay free
#endif

void limit(__rlimit_resource resource, rlim_t most, rlim_t beyond = 0) {
  const rlimit both{most, most + beyond};
  setrlimit(resource, &both);
}

// If the machine runs out of memory, the kernel ends this process before others.
void be_ended_first() {
  const Descriptor file(open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC));
  if (!file.valid()) return;
  [[maybe_unused]] const ssize_t written = write(file.get(), "1000", 4);
}

void drop_common_rights() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  be_ended_first();
  prctl(PR_SET_DUMPABLE, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
}

// --- system calls ---------------------------------------------------------------------------------------------------

// Builds a seccomp filter: a list of permitted calls, some with a condition on an argument. All others fail with EPERM
// instead of ending the process, since a later C library may try a harmless new call first.
class SystemCallFilter {
 public:
  SystemCallFilter() {
    add(BPF_STMT(kLoad, offsetof(seccomp_data, arch)));
    add(BPF_JUMP(kIfEqual, kMachine, 1, 0));
    add(BPF_STMT(kReturn, SECCOMP_RET_KILL_PROCESS));
    add(BPF_STMT(kLoad, offsetof(seccomp_data, nr)));
  }
  void allow(std::span<const int> calls) {
    for (const int call : calls) {
      add(BPF_JUMP(kIfEqual, static_cast<std::uint32_t>(call), 0, 1));
      add(BPF_STMT(kReturn, SECCOMP_RET_ALLOW));
    }
  }
  // Permits the call if the low 32 bits of the argument, masked by `mask`, equal one of the values.
  void allow_if(int call, std::size_t argument, std::uint32_t mask, std::span<const std::uint32_t> values) {
    add(BPF_JUMP(kIfEqual, static_cast<std::uint32_t>(call), 0, static_cast<std::uint8_t>(3 + 2 * values.size())));
    add(BPF_STMT(kLoad, static_cast<std::uint32_t>(offsetof(seccomp_data, args) + argument * sizeof(std::uint64_t))));
    add(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, mask));
    for (const std::uint32_t value : values) {
      add(BPF_JUMP(kIfEqual, value, 0, 1));
      add(BPF_STMT(kReturn, SECCOMP_RET_ALLOW));
    }
    add(BPF_STMT(kReturn, SECCOMP_RET_ERRNO | kNotPermitted));
  }
  // Lets the call fail with ENOSYS, so that the C library falls back to an older one.
  void hide(int call) {
    add(BPF_JUMP(kIfEqual, static_cast<std::uint32_t>(call), 0, 1));
    add(BPF_STMT(kReturn, SECCOMP_RET_ERRNO | kUnknownCall));
  }
  void forbid(std::span<const int> calls) {
    for (const int call : calls) {
      add(BPF_JUMP(kIfEqual, static_cast<std::uint32_t>(call), 0, 1));
      add(BPF_STMT(kReturn, SECCOMP_RET_ERRNO | kNotPermitted));
    }
  }
  // Applies to the calling thread and its new threads, or to all threads. Returns false if the kernel refuses it.
  bool install(bool all_others_allowed, bool all_threads) {
    add(BPF_STMT(kReturn, all_others_allowed ? SECCOMP_RET_ALLOW : SECCOMP_RET_ERRNO | kNotPermitted));
    const sock_fprog filter{static_cast<unsigned short>(program_.size()), program_.data()};
    return syscall(__NR_seccomp, SECCOMP_SET_MODE_FILTER, all_threads ? SECCOMP_FILTER_FLAG_TSYNC : 0, &filter) == 0 ||
           (!all_threads && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0);
  }

 private:
  static constexpr std::uint32_t kLoad = BPF_LD | BPF_W | BPF_ABS;
  static constexpr std::uint32_t kIfEqual = BPF_JMP | BPF_JEQ | BPF_K;
  static constexpr std::uint32_t kReturn = BPF_RET | BPF_K;
  static constexpr std::uint32_t kNotPermitted = 1;  // EPERM
  static constexpr std::uint32_t kUnknownCall = 38;  // ENOSYS

  void add(const sock_filter& line) { program_.push_back(line); }

  std::vector<sock_filter> program_;
};

constexpr std::array kReading{
    __NR_read,         __NR_write,     __NR_brk,   __NR_mmap,         __NR_munmap,         __NR_mremap,
    __NR_mprotect,     __NR_madvise,   __NR_futex, __NR_rt_sigreturn, __NR_rt_sigprocmask, __NR_clock_gettime,
    __NR_gettimeofday, __NR_getrandom, __NR_exit,  __NR_exit_group};

// System calls for threads, sockets and timers, and those by which a process queries its own state.
constexpr std::array kNetworking{
    __NR_readv,
    __NR_writev,
    __NR_close,
    __NR_fstat,
    __NR_lseek,
    __NR_fcntl,
    __NR_ioctl,
    __NR_ppoll,
    __NR_pselect6,
    __NR_epoll_create1,
    __NR_epoll_ctl,
    __NR_epoll_pwait,
    __NR_eventfd2,
    __NR_pipe2,
    __NR_dup,
    __NR_timerfd_create,
    __NR_timerfd_settime,
    __NR_bind,
    __NR_sendto,
    __NR_recvfrom,
    __NR_sendmsg,
    __NR_recvmsg,
    __NR_sendmmsg,
    __NR_recvmmsg,
    __NR_setsockopt,
    __NR_getsockopt,
    __NR_getsockname,
    __NR_getpeername,
    __NR_shutdown,
    __NR_set_robust_list,
    __NR_get_robust_list,
    __NR_rseq,
    __NR_sched_yield,
    __NR_sched_getaffinity,
    __NR_sched_getparam,
    __NR_sched_getscheduler,
    __NR_gettid,
    __NR_getpid,
    __NR_getppid,
    __NR_getuid,
    __NR_geteuid,
    __NR_getgid,
    __NR_getegid,
    __NR_uname,
    __NR_sysinfo,
    __NR_getrlimit,
    __NR_rt_sigaction,
    __NR_rt_sigtimedwait,
    __NR_sigaltstack,
    __NR_nanosleep,
    __NR_clock_nanosleep,
    __NR_clock_getres,
    __NR_restart_syscall,
    __NR_set_tid_address,
    __NR_membarrier,
    __NR_seccomp,
#if defined(__x86_64__)
    __NR_poll,
    __NR_select,
    __NR_epoll_wait,
    __NR_epoll_create,
    __NR_eventfd,
    __NR_pipe,
    __NR_dup2,
#endif
};

// These calls can only read: confine_to_network() leaves no writable file.
constexpr std::array kOpening{
    __NR_openat, __NR_newfstatat, __NR_readlinkat, __NR_faccessat, __NR_faccessat2,
    __NR_statx,  __NR_getdents64, __NR_getcwd,     __NR_pread64,
#if defined(__x86_64__)
    __NR_open,   __NR_stat,       __NR_lstat,      __NR_access,    __NR_readlink,
#endif
};

bool allow_network_calls(bool tcp) {
  constexpr std::uint32_t kAll = ~0U;
  SystemCallFilter filter;
  filter.allow(kReading);
  filter.allow(kNetworking);
  filter.allow(kOpening);
  if (tcp) filter.allow(std::array{__NR_connect});
  // The C library resolves interfaces by netlink and host names by datagrams.
  filter.allow_if(__NR_socket, 0, kAll, std::array<std::uint32_t, 3>{AF_INET, AF_INET6, AF_NETLINK});
  // New threads are permitted, new processes are not. A filter cannot see the arguments of clone3.
  filter.hide(__NR_clone3);
  filter.allow_if(__NR_clone, 0, CLONE_THREAD, std::array<std::uint32_t, 1>{CLONE_THREAD});
  filter.allow_if(__NR_prctl, 0, kAll, std::array<std::uint32_t, 2>{PR_SET_NAME, PR_GET_NAME});
  // abort() sends a signal to its own process; signals to other processes stay forbidden.
  filter.allow_if(__NR_tgkill, 0, kAll, std::array{static_cast<std::uint32_t>(getpid())});
  filter.allow_if(__NR_prlimit64, 0, kAll, std::array<std::uint32_t, 1>{0});
  return filter.install(false, false);
}

// --- files and addresses --------------------------------------------------------------------------------------------

// linux/landlock.h of Linux 6.12, of which Debian 12 has the first member only.
struct LandlockRules {
  std::uint64_t files = 0;
  std::uint64_t ports = 0;   // since version 4 of the interface
  std::uint64_t scopes = 0;  // since version 6
};
constexpr std::uint64_t kBindTcp = 1U << 0U;
constexpr std::uint64_t kConnectTcp = 1U << 1U;
constexpr std::uint64_t kScopes = 3;  // abstract UNIX sockets, signals

constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kFirstVersionRights = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1U) - 1;

// Files of the C library and of OpenSSL: host names, time zones, shared libraries, certificates.
constexpr std::array kSystemFiles{"/etc/ld.so.cache",
                                  "/etc/passwd",
                                  "/etc/localtime",
                                  "/etc/nsswitch.conf",
                                  "/etc/hosts",
                                  "/etc/resolv.conf",
                                  "/etc/host.conf",
                                  "/etc/gai.conf",
                                  "/etc/services",
                                  "/etc/ssl",
                                  "/usr/lib",
                                  "/usr/share/zoneinfo",
                                  "/usr/share/ca-certificates",
                                  "/usr/local/share/ca-certificates",
                                  "/lib",
                                  "/lib64",
                                  "/run/systemd/resolve",
                                  "/sys/devices/system/cpu",
                                  "/dev/urandom",
                                  "/dev/null",
                                  "/proc/sys/vm/overcommit_memory"};

void permit_reading(int rules, const char* path) {
  const Descriptor file(open(path, O_PATH | O_CLOEXEC));
  if (!file.valid()) return;
  landlock_path_beneath_attr permitted{};
  permitted.parent_fd = file.get();
  permitted.allowed_access = kRead;
  if (syscall(__NR_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &permitted, 0) == 0) return;
  permitted.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;  // for a file; the rights of a folder are refused there
  syscall(__NR_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &permitted, 0);
}

bool restrict_files(const NetworkConfinement& limits) {
  const auto version = syscall(__NR_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return false;
  LandlockRules handled;
  handled.files = kFirstVersionRights;
  if (version >= 4) handled.ports = limits.tcp ? kBindTcp : kBindTcp | kConnectTcp;
  if (version >= 6) handled.scopes = kScopes;
  std::size_t size = sizeof(std::uint64_t);
  if (version >= 4) size = 2 * sizeof(std::uint64_t);
  if (version >= 6) size = sizeof handled;
  const Descriptor rules(static_cast<int>(syscall(__NR_landlock_create_ruleset, &handled, size, 0)));
  if (!rules.valid()) return false;
  for (const char* path : kSystemFiles) permit_reading(rules.get(), path);
  for (const std::string& path : limits.readable) permit_reading(rules.get(), path.c_str());
  return syscall(__NR_landlock_restrict_self, rules.get(), 0) == 0;
}

}  // namespace

void confine_this_process(const Confinement& limits) {
  drop_common_rights();
  close_range(3, ~0U, 0);
  limit(RLIMIT_CPU, limits.processor_seconds, 1);  // SIGXCPU at the first, SIGKILL at the second
  if (kSanitized) return;
  limit(RLIMIT_NOFILE, 3);
  limit(RLIMIT_AS, limits.address_space_bytes);
  if (kMachine == 0) return;
  SystemCallFilter filter;
  filter.allow(kReading);
  filter.install(false, false);
}

ConfinementOutcome confine_to_network(const NetworkConfinement& limits) {
  constexpr rlim_t kDescriptors = 256;
  drop_common_rights();
  close_range(kChildMemory + 1, ~0U, 0);
  std::set_new_handler([] { _exit(kOutOfMemoryStatus); });
  if (kSanitized) return {};
  limit(RLIMIT_NOFILE, kDescriptors);
  limit(RLIMIT_AS, limits.address_space_bytes);
  const bool files = restrict_files(limits);
  return {kMachine != 0 && allow_network_calls(limits.tcp), files};
}

void forbid_opening_files() {
  if (kSanitized || kMachine == 0) return;
  SystemCallFilter filter;
  filter.forbid(kOpening);
  filter.install(true, true);
}

}  // namespace cellmirror
