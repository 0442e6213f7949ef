// Sends events to cellmirror from the threads of the DDS library.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

#include "drivers/dds/message/dds_message.hpp"
#include "ipc/sandbox/channel.hpp"

namespace cellmirror::dds {

// Any thread. Events keep their order.
class EventSender {
 public:
  // `channel` outlives it.
  explicit EventSender(Channel& channel) : channel_(channel) {}

  // Waits in a list while there is no room. The process ends where the list is full: cellmirror has stopped reading.
  void send(DdsEvent event);
  // Waits for room for a moment, which holds up the library as a slow reader does; then it is dropped.
  void send_sample(SampleReceived& sample, std::span<const std::byte> payload);
  // Sends events that wait.
  void flush();

 private:
  [[nodiscard]] bool flushed();  // under the mutex

  Channel& channel_;
  std::mutex mutex_;
  std::deque<std::vector<std::byte>> waiting_;
  std::vector<std::byte> head_;  // reused
};

}  // namespace cellmirror::dds
