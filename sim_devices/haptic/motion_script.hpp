// Motions of a simulated hand: a list of steps, as text "touch z -0.03; press 2s; drag x 0.02; letgo".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "sim_devices/haptic/axes.hpp"

namespace cellmirror::sim {

enum class MotionVerb : std::uint8_t { hold, touch, press, drag, tap, sine, circle, back, letgo, button };

struct MotionStep {
  MotionVerb verb = MotionVerb::hold;
  Coordinates direction{};   // unit vector; press: unused
  Coordinates sideways{};    // of a circle: the second axis of its plane
  double amount = 0;         // m or rad, >= 0: distance, depth, amplitude, radius
  double speed = 0.05;       // m/s or rad/s
  double duration_s = 1;     // of hold, press, letgo, sine, circle
  double period_s = 1;       // of sine, circle, tap
  double threshold = 0.1;    // N or Nm against the direction: touch, tap
  std::uint32_t times = 1;   // taps
  std::uint32_t button = 0;  // from 1
  bool on = false;
};

inline constexpr std::size_t kMaxMotionSteps = 256;
inline constexpr std::size_t kMaxMotionText = 16384;

// Steps are separated by ';' or line ends; '#' begins a comment. Reports all errors with places in `file`.
[[nodiscard]] std::vector<MotionStep> parse_motion(std::string_view text, std::string_view file,
                                                   const AxisLayout& layout, Diagnostics& diagnostics);

// All steps with their words, for --help and the page.
[[nodiscard]] std::string haptic_motion_help();

}  // namespace cellmirror::sim
