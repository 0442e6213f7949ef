// Recordings as status and the control socket report them (docs/recording.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "app/snapshot/recorder_report.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json recording_json(const RecordingReport& report);
[[nodiscard]] nlohmann::json recordings_json(std::span<const RecordingReport> reports);

}  // namespace cellmirror::app
