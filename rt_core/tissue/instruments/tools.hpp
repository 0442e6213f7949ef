// What closed scissors, hot hooks and forceps, clip applicators, suction and irrigation do.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/tissue/description/event_log.hpp"
#include "rt_core/tissue/effects/particles.hpp"
#include "rt_core/tissue/effects/surroundings.hpp"
#include "rt_core/tissue/effects/vessels.hpp"
#include "rt_core/tissue/instruments/clips.hpp"
#include "rt_core/tissue/instruments/instrument.hpp"

namespace cellmirror::tissue {

struct ToolSite {
  std::span<DeformableObject> objects;
  Vessels& vessels;
  Clips& clips;
  InstrumentContacts& finder;
  Surroundings& surroundings;
  Particles& particles;
  Pool& pool;
  EventLog& log;
  std::uint64_t step = 0;
  std::vector<std::uint32_t> found = {};  // kept for its memory
};

inline constexpr double kCutSpeed = 0.25;    // m/s, of the front between closing blades
inline constexpr double kHookDose = 2.5;     // burn a second at the hook
inline constexpr double kForcepsDose = 1.5;  // likewise

// After the step, of every instrument that was in it.
void use_tool(Instrument& instrument, ToolSite& site);
void use_fluids(const Instrument& instrument, ToolSite& site);

}  // namespace cellmirror::tissue
