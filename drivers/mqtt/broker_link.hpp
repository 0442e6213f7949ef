// A connection to a broker that comes back by itself: a thread connects, sends what a conversation has, and connects
// again after 1 to 30 s where the connection is lost, refused or not answered.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/mqtt/conversation.hpp"
#include "drivers/mqtt/reconnect_delay.hpp"
#include "ipc/sandbox/restart_delay.hpp"
#include "ipc/sandbox/sandbox_report.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/mqtt_config.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::mqtt {

class Session;

class BrokerLink {
 public:
  static constexpr std::size_t kMostInFlight = 32;             // messages that the broker has not confirmed
  static constexpr Nanoseconds kAnswerWithin{10'000'000'000};  // to CONNECT
  static constexpr Nanoseconds kFarewellWithin{1'000'000'000};

  struct Counters {
    std::uint64_t sent = 0;        // confirmed by the broker; with QoS 0 written to the socket
    std::uint64_t sent_bytes = 0;  // of these
    std::uint64_t refused = 0;     // by the broker
    std::uint64_t received = 0;
    std::uint64_t connections = 0;
    std::uint64_t failures = 0;  // attempts that failed and connections that were lost
  };

  // `conversation`, `wake` and `clock` outlive the link. Nothing begins before start().
  BrokerLink(MqttConfig config, std::string client_id, Conversation& conversation, WakeSignal& wake,
             const Clock& clock);
  ~BrokerLink();
  BrokerLink(const BrokerLink&) = delete;
  BrokerLink& operator=(const BrokerLink&) = delete;

  void start();
  // Says farewell where it is connected; waits for the thread: seconds.
  void stop();

  // Any thread.
  [[nodiscard]] Counters counters() const;
  [[nodiscard]] bool connected() const { return connected_; }
  // Why nothing reaches the broker, or what it refuses, with the remedy; empty: nothing is wrong, or not known yet.
  [[nodiscard]] std::string problem() const;

 private:
  void run();
  struct Attempt {
    Nanoseconds connected{0};  // duration of the connection
    bool broke_down = false;   // the process of the library failed
  };
  // Runs one connection until it is lost or stop() is called. Returns the reason of its end.
  Error attempt(Attempt& attempt);
  [[nodiscard]] Result<std::unique_ptr<Session>> open();
  [[nodiscard]] Result<void> wait_for_answer(Session& session);
  void serve(Session& session);
  void send_what_there_is(Session& session);
  void send(Session& session, Outgoing message);
  void take_confirmations(Session& session);
  void say_farewell(Session& session);
  void pause(Nanoseconds time);
  void set_problem(std::string text);
  [[nodiscard]] std::string endpoint() const;

  const MqttConfig config_;
  const std::string client_id_;
  Conversation& conversation_;
  WakeSignal& wake_;
  const Clock& clock_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> connected_{false};

  const std::shared_ptr<SandboxRecord> record_;
  ReconnectDelay delay_;  // the thread's, as what follows
  RestartDelay restart_delay_;
  std::deque<std::pair<int, Outgoing>> in_flight_;  // with their numbers, oldest first

  mutable std::mutex mutex_;  // of what follows
  Counters counters_;
  std::string problem_;  // of the connection
  std::string refusal_;  // the newest message that the broker has refused
  Timestamp refused_at_;
  std::thread thread_;
};

}  // namespace cellmirror::mqtt
