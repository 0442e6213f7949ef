// The faults of a head's motion, and their text form: KIND[:key=value[,key=value...]][@START..END]. What its drives do
// on the bus are the faults of sim_robot (sim_devices/faults).
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::sim {

enum class HeadFaultKind : std::uint8_t {
  stuck,    // an axis does not move, and says so
  slow,     // an axis is slower than it should be
  runaway,  // an axis drives to its stop
  deaf,     // records are ignored
  late,     // records take effect later
};
inline constexpr std::size_t kHeadFaultKinds = 5;

struct HeadFaultSpec {
  HeadFaultKind kind = HeadFaultKind::stuck;
  std::string text;  // as it was given
  // Window: seconds after the start, or after the command; [from, until).
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();
  int joint = 0;         // 1: pan, 2: tilt, 0: both
  double scale = 0.1;    // slow: of the speed
  double delay_s = 0.5;  // late
};

[[nodiscard]] std::string_view name_of(HeadFaultKind kind);
// Whether the text begins with the name of a fault of this kind, good or bad for the rest.
[[nodiscard]] bool is_head_fault(std::string_view text);
// Refuses unknown kinds (with the nearest name), unknown keys and values out of range.
[[nodiscard]] Result<HeadFaultSpec> parse_head_fault(std::string_view text);
[[nodiscard]] std::string head_fault_help();

// One that was ordered.
struct HeadFault {
  int id = 0;
  HeadFaultSpec spec;
  Timestamp origin;
  bool ended = false;
  std::uint64_t applied = 0;  // records and steps that it struck

  [[nodiscard]] bool over(Timestamp now) const { return ended || seconds(now - origin) >= spec.until_s; }
  [[nodiscard]] bool in_force(Timestamp now) const { return !over(now) && seconds(now - origin) >= spec.from_s; }
};

}  // namespace cellmirror::sim
