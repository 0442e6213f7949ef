// The faults a simulated device can have, and their text form: KIND[:key=value[,key=value...]][@START..END].
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "sim_devices/faults/message.hpp"

namespace cellmirror::sim {

enum class FaultKind : std::uint8_t {
  loss,          // messages vanish
  delay,         // messages leave later
  repeat,        // messages leave more than once
  insert,        // messages that no device of the cell sends
  reorder,       // a message is held until later ones have passed it
  corrupt,       // bits flip
  wrong_id,      // the message has another identity
  wrong_length,  // too short or too long
  frozen,        // values freeze while the device keeps sending
  nan,           // a value is not a number
  jump,          // values are off by a constant
  burst,         // messages gather and leave all at once
  death,         // the device falls silent; at the end of the window it boots again
  bus_off,       // the controller leaves the bus: an error frame, then silence, then a restart
};
inline constexpr std::size_t kFaultKinds = 14;

struct FaultSpec {
  FaultKind kind = FaultKind::loss;
  std::string text;  // as it was given

  // Window: seconds after the origin (the device's start, or the arrival of the command); [from, until).
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();

  // Which messages.
  int robot = 0;                    // from 1; 0: every
  int joint = 0;                    // from 1; 0: every
  std::optional<MessageKind> only;  // none: every kind
  double probability = 1;           // of each message that matches
  std::uint64_t every = 0;          // > 0: each n-th message that matches, instead of by chance
  std::uint64_t most = 0;           // > 0: ends after this many

  // What happens to them; which of these count depends on the kind.
  double seconds = 0;               // delay: how long; repeat: between the copies; burst: how long messages gather
  double jitter_s = 0;              // delay: added, uniform in [0, jitter)
  unsigned number = 1;              // repeat: copies; reorder: messages that pass; corrupt: bits
  double rate_hz = 10;              // insert
  double amount = 0;                // jump: rad or m
  std::optional<std::uint32_t> id;  // wrong_id, insert: the CAN identifier; none: drawn by lot
  int change = -1;                  // wrong_length: bytes or values more (positive) or less
};

[[nodiscard]] std::string_view name_of(FaultKind kind);
// Refuses unknown kinds and keys (with the nearest names), values out of range, and keys that the kind does not use.
[[nodiscard]] Result<FaultSpec> parse_fault(std::string_view text);
// A page for people: every kind, its keys, defaults and an example.
[[nodiscard]] std::string fault_help();

}  // namespace cellmirror::sim
