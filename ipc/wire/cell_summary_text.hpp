// The summary of a cell as one JSON document (docs/plant.md has its members): the data of std_msgs/String on DDS, the
// payload on MQTT.
#pragma once

#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/cell_summary.hpp"

namespace cellmirror {

// At most kMostSummaryBytes: what is beyond the limits of cell_summary.hpp is cut or left out, and robots are counted
// in robots_left_out. One line.
[[nodiscard]] std::string cell_summary_text(const CellSummary& summary);

// Of any bytes: texts and lists are cut to their limits, numbers that cannot be are refused. A document of a newer
// version is read as far as it is known; `version` tells it. Fails where it is no summary, or names no cell.
[[nodiscard]] Result<CellSummary> parse_cell_summary(std::string_view text);

// Whether `next` tells something that should not wait for the next regular summary: another health, state of a robot,
// touching pair or number of alarms. Ages, times and counters do not.
[[nodiscard]] bool has_news(const CellSummary& last, const CellSummary& next);

}  // namespace cellmirror
