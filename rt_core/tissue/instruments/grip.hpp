// Grippers: points of surfaces that closed jaws hold, and how they slip.
#pragma once

#include <span>
#include <vector>

#include "rt_core/tissue/contact/constraint_system.hpp"
#include "rt_core/tissue/description/event_log.hpp"
#include "rt_core/tissue/description/limits.hpp"
#include "rt_core/tissue/instruments/instrument.hpp"
#include "rt_core/tissue/instruments/instrument_contacts.hpp"

namespace cellmirror::tissue {

inline constexpr std::size_t kMostHeldPoints = 12;  // of an instrument

// Takes hold where the condition has become true, lets go where it is no longer. Before the step.
void update_grip(Instrument& instrument, std::span<DeformableObject> objects, InstrumentContacts& finder,
                 EventLog& log);
void release_grip(Instrument& instrument, EventLog& log);
// After a cut.
void attach_grip_again(Instrument& instrument, std::span<DeformableObject> objects);

// Constraints of one substep, for points of objects that step now.
void add_grip(ConstraintSystem& system, Instrument& instrument, std::span<DeformableObject> objects,
              const Limits& limits);
// After solve(): force and torque on the instrument, as its share of the whole step.
void take_grip(const ConstraintSystem& system, Instrument& instrument, std::span<const DeformableObject> objects);
// After the last substep: what was not strong enough slips, and is lost when it leaves the jaws. Returns what the limit
// of forces asks for.
LimitActions finish_grip(Instrument& instrument, std::span<DeformableObject> objects, Limits& limits, EventLog& log);

}  // namespace cellmirror::tissue
