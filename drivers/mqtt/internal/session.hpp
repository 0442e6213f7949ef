// One connection to a broker, in a confined process of its own (cellmirror-mqtt). One thread, which has to outlive the
// object.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/mqtt/conversation.hpp"
#include "drivers/mqtt/credentials.hpp"
#include "drivers/mqtt/message/mqtt_message.hpp"
#include "drivers/mqtt/outgoing.hpp"
#include "ipc/sandbox/sandbox_process.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/mqtt_config.hpp"

namespace cellmirror::mqtt {

class Session {
 public:
  static constexpr std::uint64_t kMemory = 128ULL << 20U;  // resident, of the process

  struct Confirmation {
    int number = 0;            // that publish() gave
    std::string refusal = {};  // reason of a refusal; empty if the message was taken
    bool by_library = false;   // the refusal is not the broker's
  };

  // Starts the process, which then connects. wait() calls `received`. Fails if the program cannot be started.
  [[nodiscard]] static Result<std::unique_ptr<Session>> make(const MqttConfig& config, const std::string& client_id,
                                                             const std::optional<Credentials>& credentials,
                                                             const Outgoing& will,
                                                             std::shared_ptr<SandboxRecord> record,
                                                             std::function<void(const Incoming&)> received);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // The broker was found and asked; accepted() tells the answer.
  [[nodiscard]] bool asked() const { return asked_; }
  [[nodiscard]] bool accepted() const { return accepted_ && !end_; }
  // The reason of the end of the connection; nothing while it lasts.
  [[nodiscard]] const std::optional<Error>& end() const { return end_; }
  // True if the connection ended because the process failed.
  [[nodiscard]] bool broke_down() const { return broke_down_; }

  void subscribe(const std::string& topic);
  // Why the broker has refused a subscription; empty: it has not.
  [[nodiscard]] const std::string& refused_subscription() const { return refused_subscription_; }
  // The message's number in this connection.
  [[nodiscard]] Result<int> publish(const Outgoing& message);
  // Since the last call. With QoS 0: written to the socket.
  [[nodiscard]] std::vector<Confirmation> take_confirmations();

  // Handles events of the process; waits for them up to `timeout`, or until the descriptor `wake` is readable.
  void wait(int wake, Nanoseconds timeout);
  // Asks the broker to end the connection without publishing the last will.
  void disconnect();

 private:
  Session(std::unique_ptr<SandboxProcess> process, std::shared_ptr<SandboxRecord> record,
          std::function<void(const Incoming&)> received);
  // Waits up to 0.5 s for room in the ring. Returns false if there is none, or if the message is too long.
  bool send(MqttRequest request, std::string_view payload = {});
  void take_events();
  // Handlers of the decoded events. They return false for an event that the process may not send now.
  bool take(const BrokerAsked& event, std::span<const std::byte> rest);
  bool take(const BrokerAccepted& event, std::span<const std::byte> rest);
  bool take(const ConnectionEnded& event, std::span<const std::byte> rest);
  bool take(const SubscriptionRefused& event, std::span<const std::byte> rest);
  bool take(const MessageConfirmed& event, std::span<const std::byte> rest);
  bool take(const MessageReceived& event, std::span<const std::byte> rest);
  void break_down(const std::string& why);

  SystemClock clock_;
  std::unique_ptr<SandboxProcess> process_;
  std::shared_ptr<SandboxRecord> record_;
  std::function<void(const Incoming&)> received_;
  bool asked_ = false;
  bool accepted_ = false;
  bool broke_down_ = false;
  std::optional<Error> end_;
  std::string refused_subscription_;
  std::vector<Confirmation> confirmations_;
  int last_number_ = 0;
  std::vector<std::byte> message_;  // reused
  std::vector<std::byte> bytes_;    // likewise
};

}  // namespace cellmirror::mqtt
