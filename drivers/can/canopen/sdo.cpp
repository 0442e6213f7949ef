#include "drivers/can/canopen/sdo.hpp"

#include "drivers/can/canopen/bytes.hpp"

namespace cellmirror::can {

std::string_view words(SdoAbort abort) {
  switch (abort) {
    case SdoAbort::toggle_not_alternated:
      return "toggle bit not alternated";
    case SdoAbort::timed_out:
      return "SDO protocol timed out";
    case SdoAbort::unknown_command:
      return "command specifier not valid or unknown";
    case SdoAbort::block_size:
      return "invalid block size";
    case SdoAbort::sequence_number:
      return "invalid sequence number";
    case SdoAbort::crc_error:
      return "CRC error";
    case SdoAbort::out_of_memory:
      return "out of memory";
    case SdoAbort::unsupported_access:
      return "unsupported access to an object";
    case SdoAbort::write_only:
      return "read of a write-only object";
    case SdoAbort::read_only:
      return "write of a read-only object";
    case SdoAbort::no_such_object:
      return "object does not exist";
    case SdoAbort::not_mappable:
      return "object cannot be mapped to the PDO";
    case SdoAbort::pdo_too_long:
      return "mapped objects exceed the PDO's length";
    case SdoAbort::length_mismatch:
      return "length of the value does not match";
    case SdoAbort::too_long:
      return "value too long";
    case SdoAbort::too_short:
      return "value too short";
    case SdoAbort::no_such_subindex:
      return "subindex does not exist";
    case SdoAbort::invalid_value:
      return "invalid value";
    case SdoAbort::value_too_high:
      return "value too high";
    case SdoAbort::value_too_low:
      return "value too low";
    case SdoAbort::no_data:
      return "no data available";
    case SdoAbort::general_error:
      return "general error";
    case SdoAbort::cannot_store:
      return "value cannot be stored";
    case SdoAbort::device_state:
      return "not possible in this state of the device";
  }
  return "abort code without a name";
}

CanFrame encode_sdo_abort(std::uint32_t cob_id, ObjectAddress address, SdoAbort abort) {
  CanFrame frame = make_frame(cob_id, {kSdoAbortCommand, 0, 0, address.subindex, 0, 0, 0, 0});
  put_le(std::span(frame.data).subspan(1), address.index, 2);
  put_le(std::span(frame.data).subspan(4), static_cast<std::uint32_t>(abort), 4);
  return frame;
}

ObjectAddress sdo_address(const CanFrame& frame) { return {get_le16(std::span(frame.data).subspan(1)), frame.data[3]}; }

}  // namespace cellmirror::can
