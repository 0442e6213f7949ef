// The words of enumerations as status, the live document and SCRIPT have them: each list once. Constant tables; may be
// used anywhere.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/plausibility.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror {

// Each table is in the order of its enumeration.
inline constexpr std::array<std::string_view, kDataStates> kDataStateWords = {
    "none", "fresh", "stale", "lost", "invalid", "implausible", "conflict"};
inline constexpr std::array<std::string_view, 5> kImplausibilityWords = {"none", "position", "velocity", "acceleration",
                                                                         "frozen"};
inline constexpr std::array<std::string_view, 3> kJointKindWords = {"revolute", "continuous", "prismatic"};
inline constexpr std::array<std::string_view, 6> kHapticPhaseWords = {"closed",   "waiting", "clutched",
                                                                      "engaging", "active",  "faulted"};
inline constexpr std::array<std::string_view, 11> kHapticFaultWords = {
    "none",        "stale", "vanished",  "not_finite",  "invalid",    "jump",
    "two_writers", "torn",  "late_tick", "stale_model", "not_passive"};
inline constexpr std::array<std::string_view, 6> kHapticAwaitedWords = {"nothing",      "reset",   "device",
                                                                        "surroundings", "outside", "rest"};
// Those of SET_MODE.
inline constexpr std::array<std::string_view, kDisplayModes> kDisplayModeWords = {
    "WFRM_display", "SMEAR", "BFRM",         "CPU_BFRM", "CAM_MAINVIEW", "LGT_TWOSIDE", "TCP_DRAW",
    "ZPF_DRAW",     "FLDR",  "GEO_VIS_TEST", "SHAD",     "BEEP",         "TEXTURES",    "ANTIALIAS"};
// Those of rob_inverse_class (manual 1.2.2).
inline constexpr std::array<std::string_view, 25> kInverseClassWords = {
    "align_FRAME",     "align_POS",       "align_X_AXIS",    "align_Y_AXIS",    "align_Z_AXIS",
    "align_XY_AXIS",   "align_YZ_AXIS",   "align_XZ_AXIS",   "align_N_AXIS",    "align_S_AXIS",
    "align_A_AXIS",    "align_XY_N_AXIS", "align_XY_S_AXIS", "align_XY_A_AXIS", "align_XZ_N_AXIS",
    "align_XZ_S_AXIS", "align_XZ_A_AXIS", "align_YZ_N_AXIS", "align_YZ_S_AXIS", "align_YZ_A_AXIS",
    "EDITH",           "BOOM_3",          "BOOM_4",          "BOOM_5",          "BOOM_6"};

// An enumerator that is added without its word does not compile.
static_assert(kDataStateWords.size() == std::size_t{std::to_underlying(DataState::conflict)} + 1);
static_assert(kImplausibilityWords.size() == std::size_t{std::to_underlying(Implausibility::frozen)} + 1);
static_assert(kJointKindWords.size() == std::size_t{std::to_underlying(JointKind::prismatic)} + 1);
static_assert(kHapticPhaseWords.size() == std::size_t{std::to_underlying(HapticPhase::faulted)} + 1);
static_assert(kHapticFaultWords.size() == std::size_t{std::to_underlying(HapticFault::not_passive)} + 1);
static_assert(kHapticAwaitedWords.size() == std::size_t{std::to_underlying(HapticAwaited::rest)} + 1);
static_assert(kDisplayModeWords.size() == std::size_t{std::to_underlying(DisplayMode::antialiasing)} + 1);
static_assert(kInverseClassWords.size() == std::size_t{std::to_underlying(InverseClass::boom_6)} + 1);

[[nodiscard]] constexpr std::string_view word(DataState state) { return kDataStateWords.at(std::to_underlying(state)); }
[[nodiscard]] constexpr std::string_view word(Implausibility why) {
  return kImplausibilityWords.at(std::to_underlying(why));
}
[[nodiscard]] constexpr std::string_view word(JointKind kind) { return kJointKindWords.at(std::to_underlying(kind)); }
[[nodiscard]] constexpr std::string_view word(HapticPhase phase) {
  return kHapticPhaseWords.at(std::to_underlying(phase));
}
[[nodiscard]] constexpr std::string_view word(HapticFault fault) {
  return kHapticFaultWords.at(std::to_underlying(fault));
}
[[nodiscard]] constexpr std::string_view word(HapticAwaited awaited) {
  return kHapticAwaitedWords.at(std::to_underlying(awaited));
}
[[nodiscard]] constexpr std::string_view word(DisplayMode mode) {
  return kDisplayModeWords.at(std::to_underlying(mode));
}
[[nodiscard]] constexpr std::string_view word(InverseClass inverse_class) {
  return kInverseClassWords.at(std::to_underlying(inverse_class));
}
[[nodiscard]] constexpr std::string_view word(DrawMode mode) {
  switch (mode) {  // its numbers are the manual's
    case DrawMode::wireframe:
      return "wireframe";
    case DrawMode::flat:
      return "flat";
    case DrawMode::gouraud:
      return "gouraud";
    case DrawMode::transparent:
      return "transparent";
  }
  return "gouraud";
}
// Whether a robot is mirrored.
[[nodiscard]] constexpr std::string_view robot_mode_word(bool online) { return online ? "mirrored" : "simulated"; }

}  // namespace cellmirror
