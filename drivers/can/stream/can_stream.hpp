// A JointStream that runs a protocol on a channel, which it may share with others.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "drivers/can/stream/can_protocol.hpp"
#include "drivers/can/stream/channel_members.hpp"
#include "drivers/can/stream/shared_channel.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/rate_meter.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::can {

// The channel's thread takes no lock that status() takes. After each call of the protocol it publishes what status()
// reports through `Latest` edges (release on its side, acquire on the reader's: latest.hpp). Those have one reader, so
// callers of status() exclude each other, and open() and close(), by a mutex that the thread never takes.
class CanStream final : public JointStream, private ChannelMember, private CanProtocolHost {
 public:
  using MakeProtocol = std::function<std::unique_ptr<CanProtocol>(CanProtocolHost&)>;

  CanStream(std::string kind, std::shared_ptr<SharedChannel> channel, const Clock& clock, MakeProtocol make_protocol);
  ~CanStream() override;

  Result<void> open(JointSampleSink& sink) override;
  void close() override;
  [[nodiscard]] JointStreamStatus status() const override;

 private:
  // What status() reports beside the protocol's part and the channel's.
  struct Report {
    RateMeter rate;
    std::uint64_t refused = 0;  // frames of its nodes that the channel did not take
  };

  // ChannelMember
  void start(Timestamp now) override;
  [[nodiscard]] CanProtocol& protocol() override { return *protocol_; }
  void publish() override;
  void count_refused() override { ++refused_; }
  void keep_error(const std::string& text) override;
  // CanProtocolHost
  bool send(const CanFrame& frame) override { return channel_->send(frame); }
  void send_from(std::size_t node, const CanFrame& frame) override { channel_->send_from(*this, node, frame); }
  void push(const JointSample& sample) override;
  void note(Severity severity, std::string_view kind, const std::string& text) override;

  std::string kind_;
  std::shared_ptr<SharedChannel> channel_;
  const Clock* clock_;
  MakeProtocol make_protocol_;

  // Replaced by open() and close() under `status_mutex_`, while the stream is no member of its channel.
  std::unique_ptr<CanProtocol> protocol_;
  JointSampleSink* sink_ = nullptr;
  bool open_ = false;
  bool begins_ = false;  // the next sample is the first after a start; the channel's thread

  // The channel's thread's.
  RateMeter rate_;
  std::uint64_t refused_ = 0;
  std::vector<std::string> last_errors_;

  mutable std::mutex status_mutex_;  // of those who ask for the status; never taken by the thread
  mutable Latest<Report> published_;
  mutable Latest<std::vector<std::string>> published_errors_;
};

}  // namespace cellmirror::can
