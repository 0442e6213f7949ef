// Faults that are injected into a node that the gateway answers for ([[device]], [[io_node]]), as people order them
// while they test a controller. Plain data, SI.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "rt_core/base/time.hpp"

namespace cellmirror {

enum class NodeFaultKind : std::uint8_t {
  death,      // without power: neither sends nor hears; then it boots
  loss,       // frames that it sends vanish
  delay,      // frames that it sends leave later
  emergency,  // it fails with an error code
  stuck,      // an input keeps its value, whatever the cell does; of I/O nodes
};
// By kind, as people write them.
inline constexpr std::array<std::string_view, 5> kNodeFaultNames{"death", "loss", "delay", "emergency", "stuck"};

// Frames that a node sends.
enum class NodeFrames : std::uint8_t { all, heartbeat, sdo, pdo, emergency };
inline constexpr std::array<std::string_view, 5> kNodeFrameNames{"all", "heartbeat", "sdo", "pdo", "emergency"};

struct NodeFault {
  NodeFaultKind kind = NodeFaultKind::death;
  Nanoseconds lasts{0};               // 0: until it is ended
  NodeFrames only = NodeFrames::all;  // loss, delay
  double probability = 1;             // loss: of each frame
  Nanoseconds by{0};                  // delay
  std::uint16_t code = 0;             // emergency
  bool analogue = false;              // stuck: an analogue input, else a digital one
  std::uint8_t input = 0;             // stuck: its number, from 0
  std::int16_t value = 0;             // stuck: for a digital input 0 or 1
};

struct NodeFaultOrder {
  std::uint8_t node = 0;  // its number in the cell file
  bool ends_all = false;  // all faults of the node; `fault` means nothing then
  NodeFault fault;
};

}  // namespace cellmirror
