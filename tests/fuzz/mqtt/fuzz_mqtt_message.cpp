// Messages in both directions between the gateway and a confined process, from arbitrary bytes.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/mqtt/message/mqtt_message.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror::mqtt;
  const auto bytes = std::as_bytes(std::span(data, size));
  std::vector<std::byte> again;
  if (auto event = decode_event(bytes)) {
    // A decoded message encodes to as many bytes, and decodes again.
    encode(event->message, again);
    CELLMIRROR_EXPECTS(again.size() + event->rest.size() == size);
    CELLMIRROR_EXPECTS(decode_event(again).has_value());
  }
  if (auto request = decode_request(bytes)) {
    encode(request->message, again);
    CELLMIRROR_EXPECTS(again.size() + request->rest.size() == size);
    CELLMIRROR_EXPECTS(decode_request(again).has_value());
  }
  return 0;
}
