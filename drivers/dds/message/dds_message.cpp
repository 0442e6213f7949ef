#include "drivers/dds/message/dds_message.hpp"

namespace cellmirror::dds {

void encode(DdsRequest& request, std::vector<std::byte>& out) { encode_variant(request, out); }

void encode(DdsEvent& event, std::vector<std::byte>& out) { encode_variant(event, out); }

std::optional<ReceivedMessage<DdsRequest>> decode_request(std::span<const std::byte> bytes) {
  return decode_message<DdsRequest>(bytes);
}

std::optional<ReceivedMessage<DdsEvent>> decode_event(std::span<const std::byte> bytes) {
  return decode_message<DdsEvent>(bytes);
}

}  // namespace cellmirror::dds
