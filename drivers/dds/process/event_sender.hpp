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

  // Keeps the event in a list while the ring is full. Ends the process when the list is full, since cellmirror then
  // does not read any more.
  void send(DdsEvent event);
  // Waits up to 200 ms for room in the ring, which delays the library like a slow reader, and then drops the sample.
  // The gap in the sequence numbers counts it as lost.
  void send_sample(SampleReceived& sample, std::span<const std::byte> payload);
  // Sends the events in the list.
  void flush();

 private:
  [[nodiscard]] bool flushed();  // under the mutex

  Channel& channel_;
  std::mutex mutex_;
  std::deque<std::vector<std::byte>> waiting_;
  std::vector<std::byte> head_;  // reused
};

}  // namespace cellmirror::dds
