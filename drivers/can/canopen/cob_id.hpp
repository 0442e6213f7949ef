// The predefined connection set (CiA 301, 7.3.3): which identifier belongs to which service of which node.
#pragma once

#include <cstdint>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

inline constexpr std::uint8_t kMaxNodeId = 127;

inline constexpr std::uint32_t kNmtCobId = 0x000;
inline constexpr std::uint32_t kSyncCobId = 0x080;
inline constexpr std::uint32_t kEmcyBase = 0x080;
inline constexpr std::uint32_t kTimeCobId = 0x100;
inline constexpr std::uint32_t kSdoResponseBase = 0x580;  // server to client
inline constexpr std::uint32_t kSdoRequestBase = 0x600;   // client to server
inline constexpr std::uint32_t kHeartbeatBase = 0x700;

// Bit 31 of a PDO's COB-ID: the PDO does not exist; bit 30: no RTR allowed; bit 29: 29-bit identifier.
inline constexpr std::uint32_t kCobIdInvalid = 0x8000'0000;
inline constexpr std::uint32_t kCobIdNoRtr = 0x4000'0000;
inline constexpr std::uint32_t kCobIdExtended = 0x2000'0000;

// `number` 1..4.
[[nodiscard]] constexpr std::uint32_t tpdo_cob_id(int number, std::uint8_t node) {
  return 0x080U + 0x100U * static_cast<std::uint32_t>(number) + node;
}
[[nodiscard]] constexpr std::uint32_t rpdo_cob_id(int number, std::uint8_t node) {
  return 0x100U + 0x100U * static_cast<std::uint32_t>(number) + node;
}

// CANopen's services use classic data frames with 11-bit identifiers.
[[nodiscard]] constexpr bool is_service_frame(const CanFrame& frame) {
  return !frame.extended && !frame.remote && !frame.error && frame.length <= 8;
}

}  // namespace cellmirror::can
