#include "config/mesh_process.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <optional>
#include <utility>

#include "ipc/sandbox/child_process.hpp"

namespace cellmirror {

namespace {

using Steady = std::chrono::steady_clock;

constexpr const char* kExportAnew = "export it again";

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
    const std::string name = signal_text(signal);
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

}  // namespace

MeshReader installed_mesh_reader() { return {program_beside_this("cellmirror-mesh-reader")}; }

Result<ScenePolygons> read_mesh_apart(const MeshRequest& request, const MeshReader& reader) {
  const Steady::time_point until = Steady::now() + reader.longest;
  auto started = start_reader(reader.program);
  if (!started) return fail("it cannot be read: " + started.error().what, started.error().remedy);
  const MeshMessage message = encode_mesh_request(request);
  std::string answer;
  const ExchangeResult result =
      exchange(started->socket.get(), Outgoing(message.parts()), until, reader.most_bytes, answer);
  started->socket.reset();
  const std::optional<int> status = started->child.end();
  if (result == ExchangeResult::too_late) return took_too_long(seconds(reader.longest));
  if (result == ExchangeResult::too_long)
    return fail(fmt::format("it cannot be read: it contains more than {} MiB", reader.most_bytes >> 20U),
                "reduce the mesh");
  if (auto polygons = decode_mesh_answer(answer, request.with_looks)) return std::move(*polygons);
  return why_ended(status);
}

}  // namespace cellmirror
