// One connection to a broker, from its beginning to its end, by Debian's libmosquitto. One thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/mqtt/conversation.hpp"
#include "drivers/mqtt/credentials.hpp"
#include "drivers/mqtt/outgoing.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/mqtt_config.hpp"

namespace cellmirror::mqtt {

class Session {
 public:
  struct Confirmation {
    int number = 0;            // that publish() gave
    std::string refusal = {};  // why the broker has not taken it; empty: it has
  };

  // `received` is called by wait(). Fails where a certificate or key cannot be used.
  [[nodiscard]] static Result<std::unique_ptr<Session>> make(const MqttConfig& config, const std::string& client_id,
                                                             const std::optional<Credentials>& credentials,
                                                             const Outgoing& will,
                                                             const std::function<void(const Incoming&)>& received);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // TCP, the beginning of TLS, CONNECT. `host`: where a broker is known to listen. accepted() tells the answer.
  [[nodiscard]] Result<void> connect(const std::string& host);
  [[nodiscard]] bool accepted() const;
  // Why it is over; none: it is not.
  [[nodiscard]] const std::optional<Error>& end() const;

  [[nodiscard]] Result<void> subscribe(const std::string& topic);
  // Why the broker has refused a subscription; empty: it has not.
  [[nodiscard]] const std::string& refused_subscription() const;
  // The message's number in this connection.
  [[nodiscard]] Result<int> publish(const Outgoing& message);
  // Since the last call. With QoS 0: written to the socket.
  [[nodiscard]] std::vector<Confirmation> take_confirmations();

  // Reads and writes what there is; waits at most `timeout` for it, or until the descriptor `wake` is readable.
  void wait(int wake, Nanoseconds timeout);
  // Asks the broker to end the connection without publishing the last will.
  void disconnect();

 private:
  struct Impl;
  explicit Session(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror::mqtt
