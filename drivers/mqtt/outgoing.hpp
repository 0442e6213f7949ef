// One message on its way to the broker. Plain data.
#pragma once

#include <cstdint>
#include <string>

namespace cellmirror::mqtt {

struct Outgoing {
  // What the outbox does with it where there is no room, and where it was not confirmed.
  enum class Kind : std::uint8_t { retained, reply, event, joint_states, other };

  Kind kind = Kind::other;
  std::string topic;
  std::string payload;
  int qos = 0;
  bool retain = false;
  std::string correlation = {};  // of a reply, as the caller gave it (MQTT 5, 3.3.2.3.6); empty: none

  [[nodiscard]] std::size_t bytes() const { return topic.size() + payload.size() + correlation.size(); }
};

}  // namespace cellmirror::mqtt
