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
// Adds a problem for each process that is being restarted and has a consequence.
void add_process_problems(Problems& out, std::span<const SandboxReport> reports);

}  // namespace cellmirror::app
