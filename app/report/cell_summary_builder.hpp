// The summary of the cell from what the gateway knows (docs/plant.md).
#pragma once

#include <cstdint>
#include <string>

#include "app/report/live_document.hpp"
#include "ipc/web/web_backend.hpp"
#include "rt_core/ports/cell_summary.hpp"

namespace cellmirror::app {

// What LiveSources does not have.
struct SummaryFacts {
  std::string host;
  std::string run;  // differs from start to start
  web::Health loop;
  std::uint64_t faults = 0;  // of the loop, since the start
  std::uint16_t page_port = 0;
  std::int64_t time_ns = 0;  // since 1970 (UTC)
};

// Its sequence stays 0: the sender counts. Lists are cut to the limits of cell_summary.hpp.
[[nodiscard]] CellSummary summary_of(const LiveSources& sources, const SummaryFacts& facts);

}  // namespace cellmirror::app
