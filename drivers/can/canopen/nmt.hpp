// Network management, heartbeat and SYNC (CiA 301, 7.2.8 and 7.2.5): frames to messages and back. Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

enum class NmtCommand : std::uint8_t {
  start = 0x01,
  stop = 0x02,
  enter_pre_operational = 0x80,
  reset_node = 0x81,
  reset_communication = 0x82,
};

enum class NmtState : std::uint8_t { boot_up = 0x00, stopped = 0x04, operational = 0x05, pre_operational = 0x7F };

struct NmtMessage {
  NmtCommand command = NmtCommand::start;
  std::uint8_t node = 0;  // 0: all nodes
  bool operator==(const NmtMessage&) const = default;
};

struct Heartbeat {
  std::uint8_t node = 0;
  NmtState state = NmtState::boot_up;
  bool operator==(const Heartbeat&) const = default;
};

// `node` 0..127, 0 for all.
[[nodiscard]] CanFrame encode_nmt(NmtMessage message);
// None for frames that are no NMT command: other identifier, wrong length, unknown command, node beyond 127.
[[nodiscard]] std::optional<NmtMessage> decode_nmt(const CanFrame& frame);

// Boot-up is the heartbeat with state 0.
[[nodiscard]] CanFrame encode_heartbeat(Heartbeat heartbeat);
// Bit 7 (the toggle bit of the older node guarding) is ignored. None for other identifiers, lengths and states.
[[nodiscard]] std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame);

// Without data, or with the counter of CiA 301 object 0x1019.
[[nodiscard]] CanFrame encode_sync(std::optional<std::uint8_t> counter = std::nullopt);
[[nodiscard]] bool is_sync(const CanFrame& frame);

// "boot-up", "stopped", "operational", "pre-operational".
[[nodiscard]] std::string_view words(NmtState state);

}  // namespace cellmirror::can
