#include "app/snapshot/haptic_names.hpp"

#include <fmt/format.h>

#include "rt_core/ports/words.hpp"

namespace cellmirror::app {

const char* explanation(HapticFault fault) {
  switch (fault) {
    case HapticFault::none:
      return "";
    case HapticFault::stale:
      return "the device gave no new sample in time";
    case HapticFault::vanished:
      return "the device's process has ended or has let go of the memory";
    case HapticFault::not_finite:
      return "a value of the device was no number, or its quaternion no rotation";
    case HapticFault::invalid:
      return "the device itself says that its values are not good";
    case HapticFault::jump:
      return "the device's pose jumped faster than a hand can be";
    case HapticFault::two_writers:
      return "two processes write into the device's memory";
    case HapticFault::torn:
      return "the device's samples could not be read whole";
    case HapticFault::late_tick:
      return "the loop missed more periods than are allowed";
    case HapticFault::stale_model:
      return "the surroundings of the instrument were not computed in time";
    case HapticFault::not_passive:
      return "the contact gave out energy faster than damping could take it";
  }
  return "";
}

const char* remedy(HapticFault fault) {
  switch (fault) {
    case HapticFault::none:
      return "";
    case HapticFault::stale:
      return "see that the device's process writes at the loop's rate, with the time of CLOCK_MONOTONIC; else "
             "stale_after_s";
    case HapticFault::vanished:
      return "start the device's process again";
    case HapticFault::not_finite:
    case HapticFault::invalid:
      return "look at the device's process";
    case HapticFault::jump:
      return "calibrate the device again; else max_speed_m_s";
    case HapticFault::two_writers:
      return "end one of the two processes";
    case HapticFault::torn:
      return "the device's process has to end each write: docs/shared-memory.md";
    case HapticFault::late_tick:
      return "see cellmirror doctor for real-time scheduling; else allowed_missed_periods";
    case HapticFault::stale_model:
      return "see the rate of contact models in the status; else model_stale_after_s";
    case HapticFault::not_passive:
      return "lower stiffness_n_m, or raise damping_n_s_m or max_passivity_damping_n_s_m";
  }
  return "";
}

const char* explanation(HapticAwaited awaited) {
  switch (awaited) {
    case HapticAwaited::nothing:
      return "";
    case HapticAwaited::reset:
      return "RESET_HAPTIC";
    case HapticAwaited::device:
      return "half a second of good samples, models and ticks";
    case HapticAwaited::surroundings:
      return "the surroundings of the instrument";
    case HapticAwaited::outside:
      return "the hand outside of bodies";
    case HapticAwaited::rest:
      return "the hand at rest for half a second";
  }
  return "";
}

std::string fault_text(const HapticState& state, std::string_view robot) {
  if (state.fault == HapticFault::none) return {};
  const std::string what = fmt::format("fault {}: {}", word(state.fault), explanation(state.fault));
  const bool stays = state.awaited == HapticAwaited::reset || state.awaited == HapticAwaited::nothing;
  if (stays) return fmt::format("{}; {}; then RESET_HAPTIC {}", what, remedy(state.fault), robot);
  return fmt::format("{}; engages again by itself, waits for {}", what, explanation(state.awaited));
}

}  // namespace cellmirror::app
