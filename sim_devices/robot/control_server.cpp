#include "sim_devices/robot/control_server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "sim_devices/robot/control_command.hpp"

namespace cellmirror::sim {
namespace {

std::string reason() { return std::strerror(errno); }

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy_n(path.data(), std::min(path.size(), sizeof(address.sun_path) - 1), address.sun_path);
  return address;
}

bool somebody_serves(const sockaddr_un& address) {
  const Descriptor probe(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  return connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

}  // namespace

ControlServer::~ControlServer() {
  if (listener_.valid()) unlink(socket_path_.c_str());
}

void ControlServer::watch_standard_input() {
  struct stat info{};
  // A closed or empty input would be readable for ever.
  if (fstat(STDIN_FILENO, &info) != 0) return;
  clients_.push_back({{}, STDIN_FILENO, STDERR_FILENO, false, false, {}});
}

Result<void> ControlServer::open(const std::string& path) {
  struct stat info{};
  const bool exists = lstat(path.c_str(), &info) == 0;
  if (exists && S_ISFIFO(info.st_mode)) {
    Descriptor fifo(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));  // O_RDWR: no end of file between writers
    if (!fifo.valid()) return fail(fmt::format("control {}: {}", path, reason()));
    const int in = fifo.get();
    clients_.push_back({std::move(fifo), in, STDERR_FILENO, false, true, {}});
    return {};
  }
  const sockaddr_un address = address_of(path);
  if (path.size() >= sizeof(address.sun_path)) {
    return fail(fmt::format("control {}: the path is longer than a socket's may be", path), "choose a shorter path");
  }
  if (exists && (!S_ISSOCK(info.st_mode) || somebody_serves(address))) {
    return fail(
        fmt::format("control {}: {} exists already", path, S_ISSOCK(info.st_mode) ? "a served socket" : "a file"),
        "choose another path");
  }
  if (exists) unlink(path.c_str());
  listener_ = Descriptor(socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const mode_t before = umask(0177);
  const bool bound =
      listener_.valid() && bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  umask(before);
  if (!bound || listen(listener_.get(), static_cast<int>(kMostClients)) != 0) {
    const std::string why = reason();
    listener_.reset();
    return fail(fmt::format("control {}: {}", path, why), "the folder has to exist and be writable");
  }
  socket_path_ = path;
  return {};
}

void ControlServer::serve(int timeout_ms, const Answer& answer) {
  std::vector<pollfd> waits;
  for (const Client& client : clients_) waits.push_back({client.in, POLLIN, 0});
  if (listener_.valid() && clients_.size() < kMostClients) waits.push_back({listener_.get(), POLLIN, 0});
  if (waits.empty() && timeout_ms < 0) timeout_ms = 1000;
  if (poll(waits.data(), waits.size(), timeout_ms) <= 0) return;
  const std::size_t known = clients_.size();
  for (std::size_t i = 0; i < known; ++i) {
    if (waits[i].revents != 0) read_from(clients_[i], answer);
  }
  if (waits.size() > known && waits[known].revents != 0) accept_clients();
  std::erase_if(clients_, [](const Client& client) { return client.in < 0; });
}

void ControlServer::accept_clients() {
  Descriptor socket(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  const int fd = socket.get();
  if (socket.valid()) clients_.push_back({std::move(socket), fd, fd, true, false, {}});
}

void ControlServer::read_from(Client& client, const Answer& answer) {
  std::array<char, 4096> buffer;
  const ssize_t n = read(client.in, buffer.data(), buffer.size());
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (n > 0) client.pending.append(buffer.data(), static_cast<std::size_t>(n));
  const bool ended = n <= 0 && !client.stays;
  if (ended && !client.pending.empty()) client.pending += '\n';  // the last line may lack its end
  for (std::size_t end = 0; (end = client.pending.find('\n')) != std::string::npos;) {
    const std::string line = client.pending.substr(0, end);
    client.pending.erase(0, end + 1);
    if (line.find_first_not_of(" \t\r") != std::string::npos) reply(client, answer(line));
  }
  if (client.pending.size() > kMaxControlLine) {
    client.pending.clear();
    reply(client, fmt::format("error: a command has at most {} bytes", kMaxControlLine));
  }
  if (ended) {
    client.own.reset();
    client.in = -1;
  }
}

void ControlServer::reply(const Client& client, std::string text) {
  text += '\n';
  // An answer that its asker does not fetch is dropped: the device does not wait for it.
  if (client.socket) {
    (void)send(client.out, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  } else if (write(client.out, text.data(), text.size()) < 0) {
    return;
  }
}

}  // namespace cellmirror::sim
