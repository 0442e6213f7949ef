// A datagram of the udp channel: what is taken as a frame can be sent and is the same again.
#include <cstdint>
#include <cstdlib>

#include "drivers/can/channel/udp_datagram.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror::can;
  const auto frame = decode_udp_datagram({data, size});
  if (!frame) return 0;
  const auto again = decode_udp_datagram(encode_udp_datagram(*frame, 0.0).view());
  if (!again || again->id != frame->id || again->length != frame->length || again->data != frame->data) std::abort();
  return 0;
}
