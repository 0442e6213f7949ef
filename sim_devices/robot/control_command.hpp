// Run-time commands of a simulated device: one per line, on standard input or over --control.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "rt_core/base/result.hpp"
#include "sim_devices/faults/fault_spec.hpp"

namespace cellmirror::sim {

struct AddFault {
  FaultSpec spec;
};
struct EndFaults {
  int id = 0;                     // 0: see kind
  std::optional<FaultKind> kind;  // none and id 0: all
};
struct SendEmergency {
  std::uint16_t code = 0;
  std::uint8_t error_register = 1;
  Source source;  // robot 0, joint 0: every
};
struct SetHeld {
  bool held = true;  // the motion stops at its present time
};
struct AskStatus {};
struct AskHelp {};
struct Quit {};

using ControlCommand = std::variant<AddFault, EndFaults, SendEmergency, SetHeld, AskStatus, AskHelp, Quit>;

inline constexpr std::size_t kMaxControlLine = 1024;

// Refuses with what is wrong and what would be right.
[[nodiscard]] Result<ControlCommand> parse_control_command(std::string_view line);
[[nodiscard]] std::string control_help();

}  // namespace cellmirror::sim
