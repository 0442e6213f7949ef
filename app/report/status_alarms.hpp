// Alarms as status and the page show them (docs/alarms.md).
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/snapshot/alarm_report.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// `most`: alarms that are listed of those that are open, and of the history.
[[nodiscard]] nlohmann::json alarms_json(const AlarmReport& report, Timestamp now, std::size_t most);
// The same as a text, for the page.
[[nodiscard]] std::string alarms_document(const AlarmReport& report, Timestamp now);

}  // namespace cellmirror::app
