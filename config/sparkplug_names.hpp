// Checks that the names a cell gives to Sparkplug differ by more than case. Private to this folder.
#pragma once

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/ports/mqtt_config.hpp"

namespace cellmirror {

// Sparkplug 3.0 lets hosts compare ids and names of metrics without regard to case. `file`: where errors are placed.
void check_sparkplug_names(const Cell& cell, const MqttConfig& mqtt, const Place& file, Diagnostics& diagnostics);

}  // namespace cellmirror
