#include "ipc/web/outgoing.hpp"

#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace cellmirror::web {

Chunk chunk_of(std::string text) {
  const auto owner = std::make_shared<const std::string>(std::move(text));
  return {owner, *owner};
}

void Outgoing::push(Chunk chunk) {
  if (chunk.bytes.empty()) return;
  pending_ += chunk.bytes.size();
  chunks_.push_back(std::move(chunk));
}

void Outgoing::drop_sent(std::size_t bytes) {
  pending_ -= bytes;
  while (bytes > 0) {
    Chunk& first = chunks_.front();
    const std::size_t part = std::min(bytes, first.bytes.size());
    first.bytes.remove_prefix(part);
    bytes -= part;
    if (first.bytes.empty()) chunks_.pop_front();
  }
}

Outgoing::Progress Outgoing::write_some(int socket) {
  constexpr std::size_t kPieces = 16;
  progressed_ = false;
  while (!chunks_.empty()) {
    std::array<iovec, kPieces> pieces{};
    const std::size_t count = std::min(kPieces, chunks_.size());
    for (std::size_t i = 0; i < count; ++i) {
      // The kernel only reads; iovec has no const form.
      pieces[i] = {const_cast<char*>(chunks_[i].bytes.data()), chunks_[i].bytes.size()};
    }
    msghdr message{};
    message.msg_iov = pieces.data();
    message.msg_iovlen = count;
    const ssize_t sent = ::sendmsg(socket, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK ? Progress::waiting : Progress::failed;
    progressed_ = progressed_ || sent > 0;
    drop_sent(static_cast<std::size_t>(sent));
  }
  return Progress::finished;
}

}  // namespace cellmirror::web
