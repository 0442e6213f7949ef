// Chains and instruments as bytes, and back from any bytes. Writing is for the tick too, reading is not.
#pragma once

#include <optional>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/haptics/instrument.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::engine {

void write_chain(StateWriter& out, const kinematics::Chain& chain) CELL_RT;
// None, and `in` fails, where it is no chain that Chain::make() makes.
[[nodiscard]] std::optional<kinematics::Chain> read_chain(StateReader& in);

void write_instrument(StateWriter& out, const haptics::Instrument& instrument) CELL_RT;
// Values are checked as the owner of the cell checks them. None, and `in` fails, where they cannot be an instrument's.
[[nodiscard]] std::optional<haptics::Instrument> read_instrument(StateReader& in);

}  // namespace cellmirror::engine
