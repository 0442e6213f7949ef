// Messages between cellmirror and cellmirror-mqtt, the process of the MQTT library. One process handles one connection
// to a broker. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "ipc/sandbox/channel.hpp"
#include "ipc/sandbox/message_bytes.hpp"

namespace cellmirror::mqtt {

inline constexpr ChannelConfig kMqttChannel{
    .to_child_bytes = 2U << 20U, .to_owner_bytes = 1U << 20U, .longest_message = (1U << 20U) - 64};

// Bytes of a received payload that the process forwards. A longer payload is cut; it is far beyond the longest command,
// so that cellmirror refuses it with the reason.
inline constexpr std::size_t kMostForwarded = 256UL << 10U;

// --- to the process -------------------------------------------------------------------------------------------------

// Connects to the broker. The first message, sent once. Paths are absolute.
struct ConnectBroker {
  std::string broker;  // name or numeric address
  std::uint16_t port = 1883;
  bool tls = false;
  std::string ca_file;      // PEM; empty with TLS: the authorities of the operating system
  std::string certificate;  // PEM; empty: none
  std::string key;
  bool has_credentials = false;
  std::string user;
  std::string password;
  std::string client_id;
  bool old_protocol = false;  // MQTT 3.1.1 in place of 5
  std::int32_t keep_alive_s = 10;
  std::string will_topic;
  std::string will_payload;
  std::int32_t will_qos = 0;
  bool will_retain = false;

  void fields(auto& bytes) {
    bytes(broker, port, tls, ca_file, certificate, key, has_credentials, user, password, client_id, old_protocol,
          keep_alive_s, will_topic, will_payload, will_qos, will_retain);
  }
};

struct SubscribeTopic {
  std::string topic;
  void fields(auto& bytes) { bytes(topic); }
};

// Publishes a message, whose payload follows.
struct PublishMessage {
  static constexpr bool kCarriesBytes = true;

  std::int32_t number = 0;  // repeated when it is confirmed
  std::string topic;
  std::int32_t qos = 0;
  bool retain = false;
  std::string correlation;  // of a reply (MQTT 5, 3.3.2.3.6); empty: none
  void fields(auto& bytes) { bytes(number, topic, qos, retain, correlation); }
};

// Ends the connection without the last will, and the process.
struct DisconnectBroker {
  void fields(auto&) {}
};

// --- from the process -----------------------------------------------------------------------------------------------

// CONNECT was sent.
struct BrokerAsked {
  void fields(auto&) {}
};

struct BrokerAccepted {
  void fields(auto&) {}
};

// The connection could not be made, or is over.
struct ConnectionEnded {
  std::string what;
  std::string remedy;
  void fields(auto& bytes) { bytes(what, remedy); }
};

struct SubscriptionRefused {
  std::string what;
  void fields(auto& bytes) { bytes(what); }
};

struct MessageConfirmed {
  std::int32_t number = 0;
  bool by_library = false;  // the refusal is the library's, not the broker's
  std::string refusal;      // empty: the broker has taken it; with QoS 0: it was written to the socket
  void fields(auto& bytes) { bytes(number, by_library, refusal); }
};

// A received message, whose payload follows.
struct MessageReceived {
  static constexpr bool kCarriesBytes = true;

  std::string topic;
  bool retained = false;
  std::string response_topic;
  std::string correlation;
  void fields(auto& bytes) { bytes(topic, retained, response_topic, correlation); }
};

using MqttRequest = std::variant<ConnectBroker, SubscribeTopic, PublishMessage, DisconnectBroker>;
using MqttEvent =
    std::variant<BrokerAsked, BrokerAccepted, ConnectionEnded, SubscriptionRefused, MessageConfirmed, MessageReceived>;

// Replaces the content of `out`. A payload is sent behind it.
void encode(MqttRequest& request, std::vector<std::byte>& out);
void encode(MqttEvent& event, std::vector<std::byte>& out);
// Return nothing if the bytes are not such a message, or if bytes follow a message that carries none.
[[nodiscard]] std::optional<ReceivedMessage<MqttRequest>> decode_request(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<ReceivedMessage<MqttEvent>> decode_event(std::span<const std::byte> bytes);

}  // namespace cellmirror::mqtt
