#include "drivers/can/canopen/nmt.hpp"

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"

namespace cellmirror::can {

CanFrame encode_nmt(NmtMessage message) {
  CELLMIRROR_EXPECTS(message.node <= kMaxNodeId);
  return make_frame(kNmtCobId, {static_cast<std::uint8_t>(message.command), message.node});
}

std::optional<NmtMessage> decode_nmt(const CanFrame& frame) {
  if (!is_service_frame(frame) || frame.id != kNmtCobId || frame.length != 2 || frame.data[1] > kMaxNodeId) return {};
  const auto command = static_cast<NmtCommand>(frame.data[0]);
  switch (command) {
    case NmtCommand::start:
    case NmtCommand::stop:
    case NmtCommand::enter_pre_operational:
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      return NmtMessage{command, frame.data[1]};
  }
  return {};
}

CanFrame encode_heartbeat(Heartbeat heartbeat) {
  CELLMIRROR_EXPECTS(heartbeat.node >= 1 && heartbeat.node <= kMaxNodeId);
  return make_frame(kHeartbeatBase + heartbeat.node, {static_cast<std::uint8_t>(heartbeat.state)});
}

std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame) {
  if (!is_service_frame(frame) || frame.length != 1) return {};
  if (frame.id <= kHeartbeatBase || frame.id > kHeartbeatBase + kMaxNodeId) return {};
  const auto state = static_cast<NmtState>(frame.data[0] & 0x7F);
  switch (state) {
    case NmtState::boot_up:
    case NmtState::stopped:
    case NmtState::operational:
    case NmtState::pre_operational:
      return Heartbeat{static_cast<std::uint8_t>(frame.id - kHeartbeatBase), state};
  }
  return {};
}

CanFrame encode_sync(std::optional<std::uint8_t> counter) {
  return counter ? make_frame(kSyncCobId, {*counter}) : make_frame(kSyncCobId, {});
}

bool is_sync(const CanFrame& frame) { return is_service_frame(frame) && frame.id == kSyncCobId && frame.length <= 1; }

std::string_view words(NmtState state) {
  switch (state) {
    case NmtState::boot_up:
      return "boot-up";
    case NmtState::stopped:
      return "stopped";
    case NmtState::operational:
      return "operational";
    case NmtState::pre_operational:
      return "pre-operational";
  }
  return "unknown";
}

}  // namespace cellmirror::can
