#include "config/reader_process/reader_child.hpp"

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

namespace cellmirror {

namespace {

// What the child does between its start and the program: the arguments of posix_spawn().
class Beginning {
 public:
  explicit Beginning(int socket) {
    posix_spawn_file_actions_init(&files_);
    posix_spawn_file_actions_adddup2(&files_, socket, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files_, socket, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&files_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&files_, STDERR_FILENO + 1);
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

  int spawn(const std::filesystem::path& program, pid_t& id) const {
    std::string name = program.filename().string();
    std::array<char*, 2> arguments{name.data(), nullptr};
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

ReaderChild& ReaderChild::operator=(ReaderChild&& other) noexcept {
  if (this != &other) {
    end();
    id_ = std::exchange(other.id_, -1);
  }
  return *this;
}

std::optional<int> ReaderChild::end() {
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

Result<StartedReader> start_reader(const std::filesystem::path& program) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail(fmt::format("no connection to its reader: {}", std::strerror(errno)));
  Descriptor own(ends[0]);
  const Descriptor theirs(ends[1]);
  pid_t id = -1;
  if (const int error = Beginning(theirs.get()).spawn(program, id); error != 0)
    return std::unexpected(not_started(program, error));
  return StartedReader{ReaderChild(id), std::move(own)};
}

Result<void> check_reader_program(const std::filesystem::path& program) {
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
