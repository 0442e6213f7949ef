#include "drivers/dds/process/event_sender.hpp"

#include <unistd.h>

#include <ctime>
#include <utility>

namespace cellmirror::dds {

namespace {

constexpr std::size_t kMostWaiting = 65'536;
constexpr int kTries = 200;
constexpr timespec kPause{0, 1'000'000};

}  // namespace

bool EventSender::flushed() {
  while (!waiting_.empty()) {
    if (!channel_.send(waiting_.front())) return false;
    waiting_.pop_front();
  }
  return true;
}

void EventSender::flush() {
  const std::scoped_lock lock(mutex_);
  static_cast<void>(flushed());
}

void EventSender::send(DdsEvent event) {
  std::vector<std::byte> bytes;
  encode(event, bytes);
  const std::scoped_lock lock(mutex_);
  if (waiting_.size() >= kMostWaiting) _exit(1);
  waiting_.push_back(std::move(bytes));
  static_cast<void>(flushed());
}

void EventSender::send_sample(SampleReceived& sample, std::span<const std::byte> payload) {
  const std::scoped_lock lock(mutex_);
  DdsEvent event = sample;
  encode(event, head_);
  for (int i = 0; i < kTries; ++i) {
    if (flushed() && channel_.send(head_, payload)) return;
    nanosleep(&kPause, nullptr);
  }
}

}  // namespace cellmirror::dds
