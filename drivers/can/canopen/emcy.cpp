#include "drivers/can/canopen/emcy.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"

namespace cellmirror::can {
namespace {

struct CodeWords {
  std::uint16_t code;
  std::uint16_t mask;
  std::string_view words;
};

// First match counts: specific codes before their classes. CiA 301 table 26, CiA 402-2 annex of error codes.
constexpr CodeWords kCodes[] = {
    {0x0000, 0xFFFF, "no error"},
    {0x2310, 0xFFFF, "continuous over current at the output"},
    {0x2320, 0xFFFF, "short circuit or earth leakage at the output"},
    {0x3110, 0xFFFF, "mains over-voltage"},
    {0x3120, 0xFFFF, "mains under-voltage"},
    {0x3210, 0xFFFF, "DC link over-voltage"},
    {0x3220, 0xFFFF, "DC link under-voltage"},
    {0x4210, 0xFFFF, "excess temperature of the device"},
    {0x4310, 0xFFFF, "excess temperature of the drive"},
    {0x5441, 0xFFFF, "contacts"},
    {0x6320, 0xFFFF, "parameter error"},
    {0x7121, 0xFFFF, "motor blocked"},
    {0x7300, 0xFF00, "sensor"},
    {0x8110, 0xFFFF, "CAN overrun"},
    {0x8120, 0xFFFF, "CAN in error passive mode"},
    {0x8130, 0xFFFF, "life guard or heartbeat error"},
    {0x8140, 0xFFFF, "recovered from bus-off"},
    {0x8150, 0xFFFF, "CAN-ID collision"},
    {0x8210, 0xFFFF, "PDO not processed due to length error"},
    {0x8220, 0xFFFF, "PDO length exceeded"},
    {0x8240, 0xFFFF, "unexpected SYNC data length"},
    {0x8250, 0xFFFF, "RPDO timeout"},
    {0x8480, 0xFFFF, "excess velocity"},
    {0x8500, 0xFFFF, "position control"},
    {0x8611, 0xFFFF, "following error"},
    {0x8612, 0xFFFF, "reference limit"},
    {0x8700, 0xFF00, "sync control"},
    {0x8A00, 0xFF00, "excess torque"},
    {0x8400, 0xFF00, "velocity control"},
    {0x8300, 0xFF00, "torque control"},
    {0x8600, 0xFF00, "positioning control"},
    {0x8100, 0xFF00, "communication"},
    {0x8200, 0xFF00, "protocol error"},
    {0x9000, 0xFF00, "external error"},
    {0xF000, 0xFF00, "additional functions"},
    {0xFF00, 0xFF00, "device specific"},
    {0x2100, 0xFF00, "current, device input side"},
    {0x2200, 0xFF00, "current inside the device"},
    {0x2300, 0xFF00, "current, device output side"},
    {0x3100, 0xFF00, "mains voltage"},
    {0x3200, 0xFF00, "voltage inside the device"},
    {0x3300, 0xFF00, "output voltage"},
    {0x4100, 0xFF00, "ambient temperature"},
    {0x4200, 0xFF00, "device temperature"},
    {0x6100, 0xFF00, "internal software"},
    {0x6200, 0xFF00, "user software"},
    {0x6300, 0xFF00, "data set"},
    {0x1000, 0xF000, "generic error"},
    {0x2000, 0xF000, "current"},
    {0x3000, 0xF000, "voltage"},
    {0x4000, 0xF000, "temperature"},
    {0x5000, 0xF000, "device hardware"},
    {0x6000, 0xF000, "device software"},
    {0x7000, 0xF000, "additional modules"},
    {0x8000, 0xF000, "monitoring"},
    {0x0000, 0xFF00, "error reset"},
};

}  // namespace

CanFrame encode_emcy(const Emcy& emcy) {
  CELLMIRROR_EXPECTS(emcy.node >= 1 && emcy.node <= kMaxNodeId);
  CanFrame frame = make_frame(kEmcyBase + emcy.node, {0, 0, emcy.error_register, 0, 0, 0, 0, 0});
  put_le(frame.data, emcy.code, 2);
  std::copy(emcy.manufacturer.begin(), emcy.manufacturer.end(), frame.data.begin() + 3);
  return frame;
}

std::optional<Emcy> decode_emcy(const CanFrame& frame) {
  if (!is_service_frame(frame) || frame.length != 8) return {};
  if (frame.id <= kEmcyBase || frame.id > kEmcyBase + kMaxNodeId) return {};
  Emcy emcy;
  emcy.node = static_cast<std::uint8_t>(frame.id - kEmcyBase);
  emcy.code = get_le16(frame.payload());
  emcy.error_register = frame.data[2];
  std::copy_n(frame.data.begin() + 3, emcy.manufacturer.size(), emcy.manufacturer.begin());
  return emcy;
}

std::string_view emcy_words(std::uint16_t code) {
  for (const CodeWords& row : kCodes) {
    if ((code & row.mask) == row.code) return row.words;
  }
  return "unknown class";
}

std::string text(const Emcy& emcy) {
  return fmt::format("node {} 0x{:04X} {}, register 0x{:02X}", emcy.node, emcy.code, emcy_words(emcy.code),
                     emcy.error_register);
}

}  // namespace cellmirror::can
