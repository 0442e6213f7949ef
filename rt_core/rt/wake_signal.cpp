#include "rt_core/rt/wake_signal.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <system_error>

namespace cellmirror {

WakeSignal::WakeSignal() : event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  // No bug of ours: the process, or the machine, has no more descriptors.
  if (!event_.valid()) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void WakeSignal::wake() noexcept {
  const std::uint64_t one = 1;
  // It can only fail where the counter is full, and then the waiter is awake anyway.
  [[maybe_unused]] const ssize_t written = write(event_.get(), &one, sizeof one);
}

bool WakeSignal::wait(Nanoseconds timeout) noexcept {
  pollfd waited{event_.get(), POLLIN, 0};
  const timespec limit{timeout.count() / 1'000'000'000, timeout.count() % 1'000'000'000};
  if (ppoll(&waited, 1, &limit, nullptr) <= 0) return false;
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t got = read(event_.get(), &count, sizeof count);
  return true;
}

}  // namespace cellmirror
