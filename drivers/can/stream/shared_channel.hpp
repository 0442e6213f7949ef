// A channel and the thread that serves it, for one stream or for several that share them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "drivers/can/stream/channel_members.hpp"
#include "drivers/can/stream/streams.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::can {

// Open while it has members. The thread takes no lock that the status of a stream takes: after each frame or timeout it
// publishes its state through a `Latest` edge, whose readers exclude each other by a mutex that the thread never takes.
class SharedChannel {
 public:
  // What the status of its streams reports of the channel. At most the longest wait for a frame (50 ms) old.
  struct Report {
    CanChannelStatus channel;
    std::uint64_t dropped_between_members = 0;
    bool ended = false;  // the log was played to its end
  };

  SharedChannel(CanChannelConfig config, const Clock& clock, CanStreamOptions options);
  // All members have left.
  ~SharedChannel();
  SharedChannel(const SharedChannel&) = delete;
  SharedChannel& operator=(const SharedChannel&) = delete;

  // Starts the member on the channel, which the first one opens. Fails where that fails. Waits until the thread has
  // done it, at most 50 ms and what the others do meanwhile. Any thread but the channel's.
  [[nodiscard]] Result<void> join(ChannelMember& member);
  // After it returns the member is not called any more; the last one closes the channel. Waits as join() does.
  void leave(ChannelMember& member);

  // Any thread.
  [[nodiscard]] Report report() const;
  [[nodiscard]] const std::string& endpoint() const { return config_.endpoint; }

  // The channel's thread, out of a protocol.
  bool send(const CanFrame& frame) { return channel_->send(frame); }
  void send_from(const ChannelMember& member, std::size_t node, const CanFrame& frame) {
    members_.send_from(member, node, frame);
  }

 private:
  struct Request {
    ChannelMember* member = nullptr;
    bool joins = false;
  };

  void ask(Request request);
  void serve_request();
  void run();
  void prepare_thread() const;
  [[nodiscard]] Nanoseconds longest_wait() const;
  void advance_when_due(bool is_frame, Timestamp received);
  void watch_bus(std::optional<CanBusState> reported);
  void watch_refused();
  void publish(bool ended);

  CanChannelConfig config_;
  const Clock* clock_;
  CanStreamOptions options_;

  std::mutex control_mutex_;  // of join() and leave(); never taken by the thread
  std::size_t joined_ = 0;

  // The thread takes `request_mutex_` only where `requested_` says that join() or leave() waits for it.
  std::mutex request_mutex_;
  std::condition_variable served_;
  std::optional<Request> request_;
  std::atomic<bool> requested_{false};
  std::atomic<bool> stop_{false};

  // The thread's own, or join()'s and leave()'s while it does not run.
  std::unique_ptr<CanChannel> channel_;
  ChannelMembers members_;
  CanBusState bus_ = CanBusState::unknown;
  Timestamp seen_due_;   // when the thread first saw that a member is due
  bool waited_ = false;  // the channel has not been open yet
  std::uint64_t refused_told_ = 0;
  Timestamp told_refused_;

  std::thread thread_;
  mutable std::mutex report_mutex_;  // of those who ask for the report; never taken by the thread
  mutable Latest<Report> published_;
};

}  // namespace cellmirror::can
