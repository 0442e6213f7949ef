#include "ipc/web/inbox.hpp"

#include <unistd.h>

namespace cellmirror::web {

void Inbox::wake() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_up_.get(), &one, sizeof one);  // full: it is signalled already
}

void Inbox::post(std::uint64_t connection, std::function<void(Connection*)> receive) {
  {
    const std::scoped_lock lock(mutex_);
    if (closed_) return;
    posted_.push_back({connection, std::move(receive)});
  }
  wake();
}

void Inbox::close() {
  const std::scoped_lock lock(mutex_);
  closed_ = true;
  posted_.clear();
}

std::vector<Posted> Inbox::take() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t got = ::read(wake_up_.get(), &count, sizeof count);
  const std::scoped_lock lock(mutex_);
  return std::exchange(posted_, {});
}

}  // namespace cellmirror::web
