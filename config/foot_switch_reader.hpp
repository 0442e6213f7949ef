// Reads [foot_switches] of a cell file. Private to this folder.
#pragma once

#include "config/foot_switches.hpp"
#include "config/table_reader.hpp"

namespace cellmirror {

[[nodiscard]] FootSwitchSettings read_foot_switches(TableReader& top);

}  // namespace cellmirror
