#include "drivers/mqtt/message/mqtt_message.hpp"

namespace cellmirror::mqtt {

void encode(MqttRequest& request, std::vector<std::byte>& out) { encode_variant(request, out); }

void encode(MqttEvent& event, std::vector<std::byte>& out) { encode_variant(event, out); }

std::optional<ReceivedMessage<MqttRequest>> decode_request(std::span<const std::byte> bytes) {
  return decode_message<MqttRequest>(bytes);
}

std::optional<ReceivedMessage<MqttEvent>> decode_event(std::span<const std::byte> bytes) {
  return decode_message<MqttEvent>(bytes);
}

}  // namespace cellmirror::mqtt
