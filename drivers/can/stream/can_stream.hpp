// A JointStream that runs a protocol on a channel in a thread of its own.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "drivers/can/stream/rate_meter.hpp"
#include "drivers/can/stream/streams.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::can {

// What a protocol may do to the outside while it is called.
class CanProtocolHost {
 public:
  virtual ~CanProtocolHost() = default;
  virtual bool send(const CanFrame& frame) = 0;
  virtual void push(const JointSample& sample) = 0;
  // Written to the log; what is wrong is kept for status() too. `kind` for the log's rate limiting: "heartbeat", ...
  virtual void note(Severity severity, std::string_view kind, const std::string& text) = 0;
};

// All calls under the stream's lock.
class CanProtocol {
 public:
  virtual ~CanProtocol() = default;
  virtual void start(Timestamp now) = 0;
  virtual void receive(const CanFrame& frame, Timestamp now) = 0;
  virtual void advance(Timestamp now) = 0;
  [[nodiscard]] virtual Timestamp next_due() const = 0;
  // received, lost, rejected, condition and details.
  virtual void describe(JointStreamStatus& status, Timestamp now) const = 0;
};

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
  bool send(const CanFrame& frame) override;
  void push(const JointSample& sample) override;
  void note(Severity severity, std::string_view kind, const std::string& text) override;

  void run();
  void prepare_thread() const;
  void watch_bus(std::optional<CanBusState> told);
  [[nodiscard]] std::string bus_condition(const CanChannelStatus& bus) const;

  std::string kind_;
  CanChannelConfig channel_config_;
  const Clock* clock_;
  CanStreamOptions options_;
  MakeProtocol make_protocol_;

  std::unique_ptr<CanChannel> channel_;
  std::thread thread_;
  std::atomic<bool> stop_{false};

  mutable std::mutex mutex_;  // guards what follows
  std::unique_ptr<CanProtocol> protocol_;
  JointSampleSink* sink_ = nullptr;
  RateMeter rate_;
  std::deque<std::string> last_errors_;
  CanBusState bus_ = CanBusState::unknown;
  bool ended_ = false;
};

}  // namespace cellmirror::can
