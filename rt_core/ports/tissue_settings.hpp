// Words that SCRIPT, cell files, the simulation of tissue and its reports share: attributes of deformable objects,
// limits of plausibility, instruments, effects. The tables A.1, A.4 and A.5 of the manual are lost; those here are
// ours. SI.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace cellmirror {

// Table A.1: attributes of a deformable object, bits of <flags> of eladyn_geo_def. Words: in the order of the
// bits.
enum class TissueAttribute : std::uint16_t {
  calculate = 1U << 0U,  // it is simulated; without, it keeps its shape
  contact = 1U << 1U,    // instruments touch it
  grasp = 1U << 2U,      // grippers hold it
  clip = 1U << 3U,       // clips can be put on it
  cut = 1U << 4U,        // scissors and a hot hook divide it
  coagulate = 1U << 5U,  // heat changes it
  tear = 1U << 6U,       // it tears beyond the strain limit of its material
  plastic = 1U << 7U,    // it yields beyond the strain limit of its material
  bodies = 1U << 8U,     // it touches rigid bodies of the cell and other objects
  gravity = 1U << 9U,    // it has weight
  visible = 1U << 10U,   // it is drawn
  wet = 1U << 11U,       // it is drawn with wet highlights
};
inline constexpr std::array<std::string_view, 12> kTissueAttributeWords = {
    "CALCULATE", "CONTACT", "GRASP",  "CLIP",    "CUT",     "COAGULATE",
    "TEAR",      "PLASTIC", "BODIES", "GRAVITY", "VISIBLE", "WET"};
inline constexpr std::uint16_t kAllTissueAttributes = 0x0FFF;
// Without GRAVITY, TEAR and PLASTIC, which need figures that fit the material.
inline constexpr std::uint16_t kDefaultTissueAttributes = 0x0D3F;

[[nodiscard]] constexpr bool has(std::uint16_t attributes, TissueAttribute which) {
  return (attributes & static_cast<std::uint16_t>(which)) != 0;
}

// Table A.5: what eladyn_plaus_param limits. The unit of the value in SCRIPT is behind it.
enum class TissueLimit : std::uint8_t {
  instrument_speed,  // mm/s of an instrument's tip from one step to the next
  penetration,       // mm of an instrument into a surface
  contact_force,     // N on an instrument
  grip_force,        // N at a held point
  node_speed,        // mm/s of a node of an object
  strain,            // 1: stretch of an element, less 1
};
inline constexpr std::size_t kTissueLimits = 6;
inline constexpr std::array<std::string_view, kTissueLimits> kTissueLimitWords = {
    "INSTRUMENT_SPEED", "PENETRATION", "CONTACT_FORCE", "GRIP_FORCE", "NODE_SPEED", "STRAIN"};

// Table A.4: what happens beyond a limit, bits of <flags> of eladyn_plaus_param. Every excess is counted in any case.
// 0: the limit is off.
enum class TissueLimitAction : std::uint8_t {
  count = 1U << 0U,    // only counted
  clamp = 1U << 1U,    // the value is held at the limit
  discard = 1U << 2U,  // the instrument has no effect in this step
  release = 1U << 3U,  // what the instrument holds is released
  freeze = 1U << 4U,   // the object concerned keeps its shape from now on (attribute CALCULATE off)
  report = 1U << 5U,   // an event in the log and on the SENSOR channel
};
inline constexpr std::array<std::string_view, 6> kTissueLimitActionWords = {"COUNT",   "CLAMP",  "DISCARD",
                                                                            "RELEASE", "FREEZE", "REPORT"};

struct TissueLimitSetting {
  std::uint8_t actions = 0;  // bits of TissueLimitAction; 0: off
  double value = 0;          // m/s, m, N or 1; not positive: off
};

[[nodiscard]] constexpr std::uint8_t bits(TissueLimitAction a, TissueLimitAction b) {
  return static_cast<std::uint8_t>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}

// At the start, by TissueLimit: what keeps a simulation sound, and a gripper that lets slip what it cannot hold.
inline constexpr std::array<TissueLimitSetting, kTissueLimits> kDefaultTissueLimits = {{
    {bits(TissueLimitAction::count, TissueLimitAction::discard), 2.0},  // instrument_speed
    {},
    {},
    {bits(TissueLimitAction::count, TissueLimitAction::clamp), 1.0},  // grip_force
    // Soft tissue that is pressed together faster than its waves run turns inside out.
    {bits(TissueLimitAction::count, TissueLimitAction::clamp), 2.0},  // node_speed
    {},
}};

// <inst_type> of rob_ela_interact, with the manual's numbers.
enum class InstrumentKind : std::uint8_t { gripper, clip_applicator, scissors, hook, forceps };
inline constexpr std::array<std::string_view, 5> kInstrumentKindWords = {"gripper", "clip applicator", "scissors",
                                                                         "coagulation hook", "coagulation forceps"};

// <test_function> of rob_ela_interact, with the manual's numbers.
enum class InstrumentTest : std::uint8_t { off, at_least, below, within, outside };

// EFFECTS <mode> ON | OFF, and SUCTION and IRRIGATION, which are ours.
enum class TissueEffect : std::uint8_t { pulse, bleeding, pool_ripples, suction, irrigation };
inline constexpr std::size_t kTissueEffects = 5;
inline constexpr std::array<std::string_view, kTissueEffects> kTissueEffectWords = {"PULSE", "BLEEDING", "POOL_RIPPLES",
                                                                                    "SUCTION", "IRRIGATION"};

// What an instrument did or what befell an object: for the log, the SENSOR channel and scores.
enum class TissueEventKind : std::uint8_t {
  grip,
  release,
  slip,
  clip,
  cut,
  coagulate,
  tear,
  bleed,
  bleed_end,
  limit,
};
inline constexpr std::array<std::string_view, 10> kTissueEventWords = {
    "grip", "release", "slip", "clip", "cut", "coagulate", "tear", "bleed", "bleed_end", "limit"};

[[nodiscard]] constexpr std::string_view word(TissueLimit limit) {
  return kTissueLimitWords.at(std::to_underlying(limit));
}
[[nodiscard]] constexpr std::string_view word(InstrumentKind kind) {
  return kInstrumentKindWords.at(std::to_underlying(kind));
}
[[nodiscard]] constexpr std::string_view word(TissueEffect effect) {
  return kTissueEffectWords.at(std::to_underlying(effect));
}
[[nodiscard]] constexpr std::string_view word(TissueEventKind kind) {
  return kTissueEventWords.at(std::to_underlying(kind));
}

}  // namespace cellmirror
