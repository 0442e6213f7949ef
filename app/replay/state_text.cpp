#include "app/replay/state_text.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "rt_core/engine/state_transfer.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::app {

namespace {

constexpr std::array<std::string_view, kRobotStateParts> kNames = {
    "mode",     "stream", "refused values", "motion",      "coupling",         "position",
    "velocity", "effort", "receive time",   "source time", "state of the data"};
constexpr std::array<std::string_view, 3> kModes = {"absent", "simulated", "mirrored"};

template <std::size_t N, class Enum>
std::string_view word(const std::array<std::string_view, N>& words, Enum value) {
  const auto number = static_cast<std::size_t>(std::to_underlying(value));
  return number < N ? words[number] : "?";
}

std::string joint_text(const engine::JointTickState& joint, std::size_t part) {
  switch (part) {
    case 5:
      return fmt::format("{:.17g}", joint.position);
    case 6:
      return fmt::format("{:.17g}", joint.velocity);
    case 7:
      return fmt::format("{:.17g}", joint.effort);
    case 8:
      return fmt::format("{} ns", joint.receive_time.ns);
    case 9:
      return fmt::format("{} ns", joint.source_time.ns);
    default:
      return fmt::format("{} ({})", word(kDataStateWords, joint.state), word(kImplausibilityWords, joint.implausible));
  }
}

}  // namespace

std::string_view part_name(std::size_t part) { return part < kNames.size() ? kNames[part] : "?"; }

std::string part_text(const engine::RobotTickState& state, std::size_t part, std::size_t joint) {
  switch (part) {
    case 0:
      return fmt::format("{}, {} joints", word(kModes, state.mode), state.joint_count);
    case 1:
      return fmt::format("{}, sample {} of {} ns, {} samples", word(kDataStateWords, state.state), state.sequence,
                         state.receive_time.ns, state.samples);
    case 2:
      return fmt::format("{} refused, {} implausible, {} conflicting, {} refused set points", state.refused_values,
                         state.implausible_values, state.conflicting_values, state.refused_setpoints);
    case 3:
      return fmt::format("moving {}, running {}, waiting {}, finished {} from {} at {} ns (outcome {}), pace {:.17g}",
                         state.motion.moving, state.motion.running, state.motion.waiting, state.motion.finished,
                         state.motion.finished_from, state.motion.finished_time.ns,
                         std::to_underlying(state.motion.outcome), state.motion.pace);
    case 4:
      return fmt::format("master in slot {}, joints {:#x}, limited {:#x}, holding {}", state.follow.master,
                         state.follow.joints, state.follow.limited, state.follow.holding);
    default:
      return joint < state.joints.size() ? joint_text(state.joints[joint], part) : "?";
  }
}

std::string haptic_text(const HapticState& state) {
  return fmt::format("{} ({}), sample {}, tip ({:.17g} {:.17g} {:.17g}) m, force ({:.17g} {:.17g} {:.17g}) N",
                     word(kHapticPhaseWords, state.phase), word(kHapticFaultWords, state.fault), state.device_sequence,
                     state.x_proxy.x(), state.x_proxy.y(), state.x_proxy.z(), state.force_W.x(), state.force_W.y(),
                     state.force_W.z());
}

}  // namespace cellmirror::app
