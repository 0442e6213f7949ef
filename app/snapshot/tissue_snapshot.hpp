// What SCRIPT asked for of deformable objects and of the instruments that act on them (manual 1.2.5, 1.2.6), for
// status, pictures and the worker that simulates tissue. SI. What became of it is in TissueState.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/ports/tissue_settings.hpp"
#include "rt_core/tissue/description/command.hpp"

namespace cellmirror::app {

struct TissueObjectSettings {
  std::string name;
  std::uint16_t attributes = 0;  // the simulation may have frozen it besides (TissueLimitAction::freeze)
};

struct TissueEffectSettings {
  bool on = false;
  int slot = -1;           // of the robot whose tool centre point it acts at, of suction and irrigation that are on
  std::string robot = {};  // its name
};

// eladyn_geo_def of an effector.
struct InstrumentCylinders {
  std::string geometry;
  tissue::InstrumentShape shape = {};
  std::uint32_t flags = 0;       // kept for reports only, as the two below
  double effector_length_m = 0;  // as given; the default is in force where it is not positive
  double fourth = 0;
};

// ela_clip_def.
struct InstrumentClip {
  std::string file;
  Pose X_TC = Pose::Identity();
};

struct TissueInstrumentSettings {
  std::string robot;
  std::size_t slot = 0;
  std::optional<tissue::InstrumentAction> action = {};  // rob_ela_interact
  std::optional<InstrumentCylinders> cylinders = {};
  std::optional<InstrumentClip> clip = {};
};

struct TissueSettings {
  bool calculating = true;     // eladyn_calc
  bool network_shown = false;  // eladyn_show_def
  std::vector<TissueObjectSettings> objects;
  std::array<TissueLimitSetting, kTissueLimits> limits = kDefaultTissueLimits;  // by TissueLimit
  std::array<TissueEffectSettings, kTissueEffects> effects{};                   // by TissueEffect
  std::vector<TissueInstrumentSettings> instruments;  // in the order of their slots; only what commands named
  std::string hyper_file;                             // as named; empty: none
  std::size_t connections = 0;                        // of the hyper file
};

}  // namespace cellmirror::app
