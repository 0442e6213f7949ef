// What SDO client and server share (CiA 301, 7.2.4): abort codes and the layout of the first byte.
#pragma once

#include <cstdint>
#include <string_view>

#include "drivers/can/canopen/object_dictionary.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// Table 22 of CiA 301. Codes of other devices are kept as numbers.
enum class SdoAbort : std::uint32_t {
  toggle_not_alternated = 0x0503'0000,
  timed_out = 0x0504'0000,
  unknown_command = 0x0504'0001,
  block_size = 0x0504'0002,
  sequence_number = 0x0504'0003,
  crc_error = 0x0504'0004,
  out_of_memory = 0x0504'0005,
  unsupported_access = 0x0601'0000,
  write_only = 0x0601'0001,
  read_only = 0x0601'0002,
  no_such_object = 0x0602'0000,
  not_mappable = 0x0604'0041,
  pdo_too_long = 0x0604'0042,
  length_mismatch = 0x0607'0010,
  too_long = 0x0607'0012,
  too_short = 0x0607'0013,
  no_such_subindex = 0x0609'0011,
  invalid_value = 0x0609'0030,
  value_too_high = 0x0609'0031,
  value_too_low = 0x0609'0032,
  no_data = 0x0800'0024,
  general_error = 0x0800'0000,
  cannot_store = 0x0800'0020,
  device_state = 0x0800'0022,
};

[[nodiscard]] std::string_view words(SdoAbort abort);

// The longest value that client and server take: no object of a drive comes near it.
inline constexpr std::size_t kMaxSdoValue = 4096;

inline constexpr std::uint8_t kSdoAbortCommand = 0x80;

// The abort of a transfer, in either direction: `cob_id` says which.
[[nodiscard]] CanFrame encode_sdo_abort(std::uint32_t cob_id, ObjectAddress address, SdoAbort abort);

// Index and subindex of the frames that carry them (bytes 1..3).
[[nodiscard]] ObjectAddress sdo_address(const CanFrame& frame);

}  // namespace cellmirror::can
