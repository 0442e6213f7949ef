// A JointStream that runs a protocol on a channel in a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/can/stream/streams.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/rate_meter.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::can {

// What a protocol may call while it is called itself, on the stream's thread.
class CanProtocolHost {
 public:
  virtual ~CanProtocolHost() = default;
  virtual bool send(const CanFrame& frame) = 0;
  virtual void push(const JointSample& sample) = 0;
  // Written to the log; what is wrong is kept for status() too. `kind` for the log's rate limiting: "heartbeat", ...
  virtual void note(Severity severity, std::string_view kind, const std::string& text) = 0;
};

// Called on the stream's thread (start() and the first publish() before that thread exists), except for describe().
class CanProtocol {
 public:
  virtual ~CanProtocol() = default;
  virtual void start(Timestamp now) = 0;
  virtual void receive(const CanFrame& frame, Timestamp now) = 0;
  virtual void advance(Timestamp now) = 0;
  [[nodiscard]] virtual Timestamp next_due() const = 0;
  // Publishes what describe() reports. Never waits.
  virtual void publish() = 0;
  // received, lost, rejected, condition and details as last published. Any thread, one at a time, while the stream's
  // thread is in any of the functions above.
  virtual void describe(JointStreamStatus& status, Timestamp now) = 0;
};

// The stream's thread takes no lock that status() takes. After each frame or timeout it publishes what status() reports
// through `Latest` edges (release on its side, acquire on the reader's: latest.hpp). Those have one reader, so callers
// of status() exclude each other, and open() and close(), by a mutex that the stream's thread never takes. Status
// is as of the last step of the thread: at most the longest wait for a frame (50 ms) old.
class CanStream final : public JointStream, private CanProtocolHost {
 public:
  using MakeProtocol = std::function<std::unique_ptr<CanProtocol>(CanProtocolHost&)>;

  CanStream(std::string kind, CanChannelConfig channel, const Clock& clock, CanStreamOptions options,
            MakeProtocol make_protocol);
  ~CanStream() override;

  Result<void> open(JointSampleSink& sink) override;
  void close() override;
  [[nodiscard]] JointStreamStatus status() const override;

 private:
  // What status() reports beside the protocol's part.
  struct Report {
    CanChannelStatus channel;
    RateMeter rate;
    bool ended = false;  // the log was played to its end
  };

  bool send(const CanFrame& frame) override;
  void push(const JointSample& sample) override;
  void note(Severity severity, std::string_view kind, const std::string& text) override;

  void run();
  void prepare_thread() const;
  // `reported`: what an error frame said; the channel may have moved on since.
  void watch_bus(std::optional<CanBusState> reported);
  void publish(bool ended);

  std::string kind_;
  CanChannelConfig channel_config_;
  const Clock* clock_;
  CanStreamOptions options_;
  MakeProtocol make_protocol_;

  // Replaced by open() and close() under `status_mutex_`, while the thread does not run; the thread uses them without.
  std::unique_ptr<CanChannel> channel_;
  std::unique_ptr<CanProtocol> protocol_;
  JointSampleSink* sink_ = nullptr;
  std::thread thread_;
  std::atomic<bool> stop_{false};

  // The thread's own, or open()'s while it does not run.
  RateMeter rate_;
  CanBusState bus_ = CanBusState::unknown;
  std::vector<std::string> last_errors_;

  mutable std::mutex status_mutex_;  // of those who ask for the status; never taken by the thread
  mutable Latest<Report> published_;
  mutable Latest<std::vector<std::string>> published_errors_;
};

}  // namespace cellmirror::can
