#include "config/mesh_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <optional>
#include <utility>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror {

namespace {

using Steady = std::chrono::steady_clock;

constexpr const char* kExportAnew = "export it again";

// A process that was started here; ended and collected at the latest when this goes.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Its status as waitpid() gives it; none if another call has collected it. A process that is already ending keeps its
  // status: the kernel ignores signals to it.
  std::optional<int> end() {
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

 private:
  pid_t id_;
};

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

// What is left to send, from the front.
class Outgoing {
 public:
  explicit Outgoing(const std::vector<std::string_view>& parts) : parts_(parts.begin(), parts.end()) {}
  [[nodiscard]] bool empty() const { return parts_.empty(); }
  // As much as possible without waiting. False if there is no reader any more.
  bool send_some(int fd) {
    std::array<iovec, 16> vectors{};
    std::size_t count = 0;
    for (; count < std::min(vectors.size(), parts_.size()); ++count)
      vectors[count] = {const_cast<char*>(parts_[count].data()), parts_[count].size()};
    msghdr message{};
    message.msg_iov = vectors.data();
    message.msg_iovlen = count;
    const ssize_t sent = sendmsg(fd, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ENOBUFS;
    drop(static_cast<std::size_t>(sent));
    return true;
  }
  void clear() { parts_.clear(); }

 private:
  void drop(std::size_t bytes) {
    while (!parts_.empty() && bytes >= parts_.front().size()) {
      bytes -= parts_.front().size();
      parts_.pop_front();
    }
    if (!parts_.empty()) parts_.front().remove_prefix(bytes);
  }
  std::deque<std::string_view> parts_;
};

enum class ExchangeResult { ended, too_late, too_long };

// Sends and receives at the same time, so that neither side waits for the other for ever, until the other end is shut.
ExchangeResult exchange(int fd, Outgoing request, Steady::time_point until, std::size_t most, std::string& answer) {
  std::vector<char> part(256UL << 10U);
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Steady::now()).count();
    if (left <= 0) return ExchangeResult::too_late;
    pollfd wait{fd, static_cast<short>(request.empty() ? POLLIN : POLLIN | POLLOUT), 0};
    if (poll(&wait, 1, static_cast<int>(std::min<decltype(left)>(left, 1000))) <= 0) continue;
    if (!request.empty() && (wait.revents & POLLOUT) != 0) {
      if (!request.send_some(fd)) request.clear();
      if (request.empty()) shutdown(fd, SHUT_WR);
    }
    if ((wait.revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;
    const ssize_t count = recv(fd, part.data(), part.size(), MSG_DONTWAIT);
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) continue;
    if (count <= 0) return ExchangeResult::ended;
    if (answer.size() + static_cast<std::size_t>(count) > most) return ExchangeResult::too_long;
    answer.append(part.data(), static_cast<std::size_t>(count));
  }
}

std::string seconds(std::chrono::milliseconds time) {
  return fmt::format("{:g} s", std::chrono::duration<double>(time).count());
}

std::unexpected<Error> took_too_long(const std::string& time) {
  return fail(fmt::format("it cannot be read: its reader took more than {}", time),
              "reduce the mesh, or export it again");
}

// Why there is no answer.
std::unexpected<Error> why_ended(std::optional<int> status) {
  if (status && WIFSIGNALED(*status)) {
    const int signal = WTERMSIG(*status);
    if (signal == SIGXCPU) return took_too_long("60 s of CPU time");
    const char* known = sigabbrev_np(signal);
    const std::string name = known != nullptr ? fmt::format("{} (SIG{})", signal, known) : std::to_string(signal);
    if (signal == SIGKILL)
      return fail(
          fmt::format("it cannot be read: its reader was ended with signal {}, as by a system that is out of memory",
                      name),
          "reduce the mesh, or free memory of other programs");
    return fail(fmt::format("it cannot be read: its reader ended with signal {}: the file is damaged", name),
                kExportAnew);
  }
  if (status && WIFEXITED(*status) && WEXITSTATUS(*status) != 0) {
    return fail(
        fmt::format("it cannot be read: its reader ended with status {}: the file is damaged", WEXITSTATUS(*status)),
        kExportAnew);
  }
  return fail("it cannot be read: its reader's answer is damaged", kExportAnew);
}

Error not_started(const MeshReader& reader, int error) {
  return {fmt::format("{} cannot be started: {}", reader.program.string(), std::strerror(error)),
          "install it beside cellmirror; both are built together"};
}

}  // namespace

MeshReader installed_mesh_reader() {
  // Once: where the program is replaced while it runs, its place stays.
  static const std::filesystem::path folder = [] {
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  }();
  return {folder / "cellmirror-mesh-reader"};
}

Result<void> check_mesh_reader(const MeshReader& reader) {
  if (access(reader.program.c_str(), X_OK) != 0) return std::unexpected(not_started(reader, errno));
  return {};
}

Result<ScenePolygons> read_mesh_apart(const MeshRequest& request, const MeshReader& reader) {
  const Steady::time_point until = Steady::now() + reader.longest;
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail(fmt::format("it cannot be read: no connection to its reader: {}", std::strerror(errno)));
  Descriptor own(ends[0]);
  Descriptor theirs(ends[1]);
  pid_t id = -1;
  if (const int error = Beginning(theirs.get()).spawn(reader.program, id); error != 0) {
    const Error why = not_started(reader, error);
    return fail("it cannot be read: " + why.what, why.remedy);
  }
  Child child(id);
  theirs.reset();
  const MeshMessage message = encode_mesh_request(request);
  std::string answer;
  const ExchangeResult result = exchange(own.get(), Outgoing(message.parts()), until, reader.most_bytes, answer);
  own.reset();
  const std::optional<int> status = child.end();
  if (result == ExchangeResult::too_late) return took_too_long(seconds(reader.longest));
  if (result == ExchangeResult::too_long)
    return fail(fmt::format("it cannot be read: it contains more than {} MiB", reader.most_bytes >> 20U),
                "reduce the mesh");
  if (auto polygons = decode_mesh_answer(answer, request.with_looks)) return std::move(*polygons);
  return why_ended(status);
}

}  // namespace cellmirror
