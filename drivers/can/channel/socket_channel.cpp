#include "drivers/can/channel/socket_channel.hpp"

#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "drivers/can/channel/error_frame.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kFirstBackOff = 50ms;
constexpr Nanoseconds kLongestBackOff = 1s;
constexpr Nanoseconds kCheckPeriod = 500ms;
constexpr std::int64_t kOldestStamp_ns = 1'000'000'000;

std::int64_t now_ns(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

void set_receive_buffer(int fd, int bytes) {
  if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) == 0) return;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
}

ClockPair ClockPair::read() { return {now_ns(CLOCK_MONOTONIC), now_ns(CLOCK_REALTIME)}; }

Timestamp ClockPair::monotonic(std::int64_t stamp_real_ns) const {
  const std::int64_t age = real_ns - stamp_real_ns;
  if (stamp_real_ns == 0 || age < 0 || age > kOldestStamp_ns) return {monotonic_ns};
  return {monotonic_ns - age};
}

Ancillary Ancillary::of(msghdr& message) {
  Ancillary result;
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SO_TIMESTAMPNS && c->cmsg_len >= CMSG_LEN(sizeof(timespec))) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      result.stamp_real_ns = std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec;
    } else if (c->cmsg_type == SO_RXQ_OVFL && c->cmsg_len >= CMSG_LEN(sizeof(std::uint32_t))) {
      std::memcpy(&result.dropped, CMSG_DATA(c), sizeof result.dropped);
      result.has_dropped = true;
    }
  }
  return result;
}

void send_messages(int fd, std::span<mmsghdr> messages, std::span<int> errors) {
  std::ranges::fill(errors, 0);
  for (std::size_t done = 0; done < messages.size();) {
    const std::span<mmsghdr> rest = messages.subspan(done);
    const int count = fd < 0 ? -1 : sendmmsg(fd, rest.data(), static_cast<unsigned>(rest.size()), MSG_DONTWAIT);
    if (count <= 0) errors[done] = fd < 0 ? ENOTCONN : errno;
    done += count <= 0 ? 1 : static_cast<std::size_t>(count);
  }
}

Result<void> SocketChannel::open_or_wait() {
  auto opened = open_socket();
  if (opened) {
    status_.waits_for.clear();
  } else if (!status_.waits_for.empty()) {
    wait_for_what_is_missing(opened.error());
    return {};
  }
  return opened;
}

void SocketChannel::wait_for_what_is_missing(const Error& error) {
  const std::string text = error.text();
  go_down(status_.waits_for.empty() ? text : "waits for " + status_.waits_for + ": " + text);
}

CanReceive SocketChannel::receive(ReceivedCanFrame& frame, Nanoseconds timeout) {
  if (give(frame)) return CanReceive::frame;
  const Timestamp deadline = clock_.now() + timeout;
  for (;;) {
    if (socket_.valid() && !fill()) socket_.reset();
    if (give(frame)) return CanReceive::frame;
    const Timestamp now = clock_.now();
    check_interface(now);
    if (now >= deadline) break;
    if (!socket_.valid()) reopen_when_due(now);
    wait(deadline - now);
  }
  const bool down = !socket_.valid() || status_.bus == CanBusState::down;
  return down ? CanReceive::down : CanReceive::timeout;
}

bool SocketChannel::give(ReceivedCanFrame& frame) {
  if (next_ == batch_size_) {
    next_ = 0;
    batch_size_ = 0;
    return false;
  }
  frame = batch_[next_++];
  return true;
}

void SocketChannel::put(const CanFrame& frame, Timestamp receive_time) {
  if (batch_size_ < batch_.size()) batch_[batch_size_++] = {frame, receive_time};
}

void SocketChannel::wait(Nanoseconds time) {
  if (!socket_.valid()) {
    std::this_thread::sleep_for(std::min(time, kFirstBackOff));
    return;
  }
  time = std::min(time, kCheckPeriod);
  const timespec limit{time.count() / 1'000'000'000, time.count() % 1'000'000'000};
  pollfd descriptor{socket_.get(), POLLIN, 0};
  const int ready = ppoll(&descriptor, 1, &limit, nullptr);
  // An error that reading does not clear would make this loop spin.
  if (ready > 0 && (descriptor.revents & POLLIN) == 0) std::this_thread::sleep_for(1ms);
}

void SocketChannel::check_interface(Timestamp now) {
  if (now < next_check_) return;
  next_check_ = now + kCheckPeriod;
  if (socket_.valid() && !is_current()) socket_.reset();
}

void SocketChannel::reopen_when_due(Timestamp now) {
  if (now < next_try_) return;
  last_dropped_ = 0;
  if (const auto opened = open_socket(); !opened) {
    wait_for_what_is_missing(opened.error());
    back_off_ = std::clamp(2 * back_off_, kFirstBackOff, kLongestBackOff);
    next_try_ = now + back_off_;
    return;
  }
  back_off_ = Nanoseconds{0};
  status_.waits_for.clear();
  ++status_.reopened;
}

void SocketChannel::count_sent(std::span<const int> errors, std::span<bool> sent) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sent[i] = errors[i] == 0;
    if (sent[i]) {
      ++status_.sent;
    } else {
      refuse(errors[i]);
    }
  }
}

void SocketChannel::note_dropped(const Ancillary& ancillary) {
  if (!ancillary.has_dropped || ancillary.dropped == last_dropped_) return;
  const std::uint32_t more = ancillary.dropped - last_dropped_;  // the kernel's counter may wrap
  last_dropped_ = ancillary.dropped;
  status_.receive_dropped += more;
}

void SocketChannel::go_down(const std::string& why) {
  status_.bus = CanBusState::down;
  status_.last_error = why;
}

void SocketChannel::note_refused(const std::string& why) {
  ++status_.send_refused;
  if (status_.bus != CanBusState::down) status_.last_error = why;
}

}  // namespace cellmirror::can
