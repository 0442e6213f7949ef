#include "ipc/control/control_connection.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <string_view>

#include "ipc/control/control_server.hpp"

namespace cellmirror {

ControlConnection::Progress ControlConnection::read_some() {
  std::array<char, 4096> chunk;
  const ssize_t got = ::recv(socket_.get(), chunk.data(), chunk.size(), 0);
  if (got == 0) return Progress::failed;  // the client left before its request was complete
  if (got < 0) return errno == EAGAIN || errno == EINTR ? Progress::waiting : Progress::failed;
  const std::size_t searched = buffer_.size();
  buffer_.append(chunk.data(), static_cast<std::size_t>(got));
  position_ = buffer_.find('\n', searched);
  if (position_ == std::string::npos) {
    return buffer_.size() > kMaxControlRequestBytes ? Progress::too_long : Progress::waiting;
  }
  return position_ > kMaxControlRequestBytes ? Progress::too_long : Progress::request_complete;
}

std::string_view ControlConnection::request() const {
  std::string_view line = std::string_view(buffer_).substr(0, position_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

void ControlConnection::answer(std::string text, Timestamp deadline) {
  buffer_ = std::move(text);
  if (!buffer_.ends_with('\n')) buffer_ += '\n';
  position_ = 0;
  answering_ = true;
  deadline_ = deadline;
}

ControlConnection::Progress ControlConnection::write_some() {
  while (position_ < buffer_.size()) {
    const ssize_t sent =
        ::send(socket_.get(), buffer_.data() + position_, buffer_.size() - position_, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0) {
      if (errno == EINTR) continue;
      return errno == EAGAIN ? Progress::waiting : Progress::failed;
    }
    position_ += static_cast<std::size_t>(sent);
  }
  return Progress::finished;
}

}  // namespace cellmirror
