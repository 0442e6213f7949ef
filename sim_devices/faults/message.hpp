// Input of the fault pipeline: a message of any protocol, with its sending time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "rt_core/base/time.hpp"

namespace cellmirror::sim {

enum class MessageKind : std::uint8_t {
  sample,     // joint values: a TPDO, a JointState, a frame of DBC signals
  heartbeat,  // CANopen NMT error control
  boot_up,
  emergency,  // EMCY
  sdo,        // answer of the SDO server
  sync,
  foreign,    // inserted: without a sender
  bus_error,  // an error frame
  other,
};
inline constexpr std::array<std::string_view, 9> kMessageKindNames{
    "sample", "heartbeat", "boot_up", "emergency", "sdo", "sync", "foreign", "bus_error", "other"};

constexpr std::string_view name_of(MessageKind kind) { return kMessageKindNames[static_cast<std::size_t>(kind)]; }

struct Source {
  int robot = 0;  // from 1; 0: none
  int joint = 0;  // from 1; 0: the robot as a whole
};

template <class M>
struct Outgoing {
  Timestamp time;  // sending time
  Source source;
  MessageKind kind = MessageKind::other;
  M message;
};

// Joint values before they are encoded, SI.
struct JointValue {
  double position = 0;  // rad or m
  double velocity = 0;  // rad/s or m/s
  double effort = 0;    // Nm or N
};

}  // namespace cellmirror::sim
