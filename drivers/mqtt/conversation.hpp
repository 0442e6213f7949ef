// What is said over one connection to a broker. The connection's thread makes all calls but those of the classes that
// implement it; what these share with others they lock.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/mqtt/outgoing.hpp"

namespace cellmirror::mqtt {

struct Incoming {
  std::string_view topic;
  std::string_view payload;
  bool retained = false;  // it was published before the subscription (3.3.1.3)
  std::string_view response_topic = {};
  std::string_view correlation = {};
};

class Conversation {
 public:
  virtual ~Conversation() = default;
  // Before each attempt to connect: the last will.
  [[nodiscard]] virtual Outgoing begin() = 0;
  // The broker was asked for the connection, with the last will.
  virtual void asked() {}
  // The topics to subscribe to.
  [[nodiscard]] virtual std::vector<std::string> subscriptions() const = 0;
  // The broker has accepted the connection, and was asked for the subscriptions.
  virtual void connected() = 0;
  [[nodiscard]] virtual std::optional<Outgoing> next() = 0;
  virtual void received(const Incoming& message) = 0;
  // The connection is lost; `unconfirmed`: what was taken and not confirmed by the broker, oldest first.
  virtual void lost(std::vector<Outgoing> unconfirmed) = 0;
  // The last messages of a connection that is ended on purpose.
  [[nodiscard]] virtual std::vector<Outgoing> farewell() = 0;
};

}  // namespace cellmirror::mqtt
