#include "ipc/sandbox/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include "ipc/sandbox/channel.hpp"

namespace cellmirror {

namespace {

// Arguments of posix_spawn(): the steps between the start of the process and its program.
class Beginning {
 public:
  Beginning() {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
    // Neither the gateway's signals nor its priority, and no Ctrl-C that is meant for the gateway.
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSCHEDULER |
                                               POSIX_SPAWN_SETPGROUP);
    sigset_t signals;
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    const sched_param no_priority{};
    posix_spawnattr_setschedpolicy(&attributes_, SCHED_OTHER);
    posix_spawnattr_setschedparam(&attributes_, &no_priority);
    posix_spawnattr_setpgroup(&attributes_, 0);
  }
  ~Beginning() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  Beginning(const Beginning&) = delete;
  Beginning& operator=(const Beginning&) = delete;

  void give(int own, int theirs) { posix_spawn_file_actions_adddup2(&files_, own, theirs); }
  void discard(int theirs) { posix_spawn_file_actions_addopen(&files_, theirs, "/dev/null", O_WRONLY, 0); }
  void close_from(int theirs) { posix_spawn_file_actions_addclosefrom_np(&files_, theirs); }

  int spawn(const std::filesystem::path& program, const std::string& argument, pid_t& id) const {
    std::string name = program.filename().string();
    std::string subject = argument;
    std::array<char*, 3> arguments{name.data(), argument.empty() ? nullptr : subject.data(), nullptr};
    return posix_spawn(&id, program.c_str(), &files_, &attributes_, arguments.data(), environ);
  }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

Error not_started(const std::filesystem::path& program, int error) {
  return {fmt::format("{} cannot be started: {}", program.string(), std::strerror(error)),
          "install it beside cellmirror; both are built together"};
}

}  // namespace

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this != &other) {
    end();
    id_ = std::exchange(other.id_, -1);
  }
  return *this;
}

std::optional<int> ChildProcess::end() {
  if (id_ <= 0) return std::nullopt;
  kill(id_, SIGKILL);
  int status = 0;
  pid_t collected = -1;
  do {
    collected = waitpid(id_, &status, 0);
  } while (collected < 0 && errno == EINTR);
  const bool own = collected == id_;
  id_ = -1;
  return own ? std::optional(status) : std::nullopt;
}

std::optional<int> ChildProcess::changed() {
  if (id_ <= 0) return std::nullopt;
  int status = 0;
  const pid_t found = waitpid(id_, &status, WNOHANG | WUNTRACED);
  if (found != id_) return std::nullopt;
  if (!WIFSTOPPED(status)) id_ = -1;
  return status;
}

Result<StartedReader> start_reader(const std::filesystem::path& program) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail(fmt::format("no connection to its reader: {}", std::strerror(errno)));
  Descriptor own(ends[0]);
  const Descriptor theirs(ends[1]);
  Beginning beginning;
  beginning.give(theirs.get(), STDIN_FILENO);
  beginning.give(theirs.get(), STDOUT_FILENO);
  beginning.discard(STDERR_FILENO);
  beginning.close_from(STDERR_FILENO + 1);
  pid_t id = -1;
  if (const int error = beginning.spawn(program, {}, id); error != 0)
    return std::unexpected(not_started(program, error));
  return StartedReader{ChildProcess(id), std::move(own)};
}

Result<ChildProcess> start_on_channel(const std::filesystem::path& program, const std::string& subject,
                                      const Descriptor& socket, const Descriptor& memory) {
  // The actions run in this order: a socket whose number is kChildMemory would be replaced before it is used.
  const Descriptor high_socket(fcntl(socket.get(), F_DUPFD_CLOEXEC, kChildMemory + 1));
  if (!high_socket.valid()) return std::unexpected(not_started(program, errno));
  Beginning beginning;
  beginning.give(memory.get(), kChildMemory);
  beginning.give(high_socket.get(), kChildSocket);
  beginning.discard(STDOUT_FILENO);
  beginning.discard(STDERR_FILENO);
  beginning.close_from(kChildMemory + 1);
  pid_t id = -1;
  if (const int error = beginning.spawn(program, subject, id); error != 0)
    return std::unexpected(not_started(program, error));
  return ChildProcess(id);
}

std::string signal_text(int signal) {
  const char* known = sigabbrev_np(signal);
  return known != nullptr ? fmt::format("{} (SIG{})", signal, known) : std::to_string(signal);
}

Result<void> check_program(const std::filesystem::path& program) {
  if (access(program.c_str(), X_OK) != 0) return std::unexpected(not_started(program, errno));
  return {};
}

std::filesystem::path program_beside_this(std::string_view name) {
  // Once: where the program is replaced while it runs, its place stays.
  static const std::filesystem::path folder = [] {
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  }();
  std::error_code error;
  const std::filesystem::path installed = folder.parent_path() / "libexec" / "cellmirror" / name;
  return std::filesystem::exists(installed, error) ? installed : folder / name;
}

}  // namespace cellmirror
