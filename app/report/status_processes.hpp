// The confined processes of the gateway in status and metrics (docs/status.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "app/report/problem.hpp"
#include "ipc/sandbox/sandbox_report.hpp"
#include "ipc/web/metrics_text.hpp"

namespace cellmirror::app {

[[nodiscard]] nlohmann::json processes_json(std::span<const SandboxReport> reports);
void add_processes(web::MetricsText& out, std::span<const SandboxReport> reports);
// Of those of DDS that do not run now; the connection to an MQTT broker reports its own problem.
void add_process_problems(Problems& out, std::span<const SandboxReport> reports);

}  // namespace cellmirror::app
