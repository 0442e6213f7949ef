// One connection to a broker, from its beginning to its end, by Debian's libmosquitto. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "drivers/mqtt/message/mqtt_message.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mqtt {

class BrokerSession {
 public:
  struct Events {
    std::function<void()> accepted;
    std::function<void(const std::string& why)> subscription_refused;
    std::function<void(const MessageConfirmed& message)> confirmed;
    std::function<void(MessageReceived& message, std::span<const std::byte> payload)> received;
  };

  // Fails if a certificate or key cannot be used.
  [[nodiscard]] static Result<std::unique_ptr<BrokerSession>> make(const ConnectBroker& wanted, Events events);
  ~BrokerSession();
  BrokerSession(const BrokerSession&) = delete;
  BrokerSession& operator=(const BrokerSession&) = delete;

  // Opens TCP and TLS and sends CONNECT. A program is known to listen at `host`. Blocks as long as the kernel does.
  [[nodiscard]] Result<void> connect(const std::string& host);
  // The reason of the end of the connection; nothing while it lasts.
  [[nodiscard]] const std::optional<Error>& end() const;

  void subscribe(const std::string& topic);
  void publish(const PublishMessage& message, std::span<const std::byte> payload);
  // Asks the broker to end the connection without publishing the last will.
  void disconnect();

  // The descriptor for poll(); negative after the end of the connection.
  [[nodiscard]] int socket() const;
  [[nodiscard]] bool wants_to_write() const;
  // Handles the result of poll(). To be called at least once a second, for the timers of the protocol.
  void read_and_write(short events);

 private:
  struct Impl;
  explicit BrokerSession(std::unique_ptr<Impl> impl);
  void report_confirmed();

  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror::mqtt
