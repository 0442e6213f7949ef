// From a cell file's entry to what a session needs: mappings resolved, everything checked.
#pragma once

#include <optional>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

struct Cia402NodePlan {
  Cia402NodeConfig config;
  std::vector<TpdoConfig> tpdos;  // valid mappings, COB-IDs filled in
};

struct Cia402Plan {
  Cia402StreamConfig config;
  std::vector<Cia402NodePlan> nodes;
};

// Reads the EDS or DCF of each node. The mapping of the cell file wins over the EDS; without both it is
// TPDO1 = 0x6041:00/16 + 0x6064:00/32, with every SYNC where this stream produces SYNC, else event driven. All errors
// are reported; no plan where there was one.
[[nodiscard]] std::optional<Cia402Plan> plan_cia402(const Cia402StreamConfig& config, Diagnostics& diagnostics);

}  // namespace cellmirror::can
