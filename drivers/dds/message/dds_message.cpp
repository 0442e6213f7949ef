#include "drivers/dds/message/dds_message.hpp"

#include <utility>

#include "ipc/sandbox/message_bytes.hpp"

namespace cellmirror::dds {

namespace {

template <class Message>
inline constexpr bool kCarriesSample = std::is_same_v<Message, WriteSample> || std::is_same_v<Message, SampleReceived>;

}  // namespace

void encode(DdsRequest& request, std::vector<std::byte>& out) { encode_variant(request, out); }

void encode(DdsEvent& event, std::vector<std::byte>& out) { encode_variant(event, out); }

namespace {

template <class Variant>
std::optional<Received<Variant>> decoded(std::span<const std::byte> bytes) {
  Received<Variant> received;
  if (!decode_variant(bytes, received.message, received.rest)) return std::nullopt;
  const bool may_have_more =
      std::visit([]<class Message>(const Message&) { return kCarriesSample<Message>; }, received.message);
  if (!received.rest.empty() && !may_have_more) return std::nullopt;
  return received;
}

}  // namespace

std::optional<Received<DdsRequest>> decode_request(std::span<const std::byte> bytes) {
  return decoded<DdsRequest>(bytes);
}

std::optional<Received<DdsEvent>> decode_event(std::span<const std::byte> bytes) { return decoded<DdsEvent>(bytes); }

}  // namespace cellmirror::dds
