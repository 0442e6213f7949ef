// What can go wrong with a haptic device, as text "jump:by=0.05@3..4".
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror::sim {

enum class HapticFaultKind : std::uint8_t {
  freeze,     // nothing is written any more, the process lives
  stuck,      // values freeze, writing continues
  jump,       // the pose is off by `by`
  nan,        // a coordinate is not a number
  rotation,   // the quaternion is no rotation
  late,       // time stamps are older by `s`
  dead,       // the process is killed without a word
  twice,      // a second process writes into the same block
  invalid,    // the device says that its values are not good
  torn,       // the process is killed while it writes
  unbounded,  // values beyond any workspace
};

struct HapticFaultSpec {
  HapticFaultKind kind = HapticFaultKind::freeze;
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();
  double by = 0.05;      // m and rad, of a jump
  double late_s = 0.02;  // of late
  std::string text;      // as it was given
};

// KIND[:key=value][@START..END] or @START; seconds since the device first wrote.
[[nodiscard]] Result<HapticFaultSpec> parse_haptic_fault(std::string_view text);
[[nodiscard]] std::string_view name_of(HapticFaultKind kind);
[[nodiscard]] std::string haptic_fault_help();

// What the fault makes of a sample: of those kinds that change values only.
void strike(const HapticFaultSpec& fault, const HapticSample& before, HapticSample& sample);

}  // namespace cellmirror::sim
