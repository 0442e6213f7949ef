#include "app/report/status_processes.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

namespace cellmirror::app {

nlohmann::json processes_json(std::span<const SandboxReport> reports) {
  nlohmann::json out = nlohmann::json::array();
  for (const SandboxReport& report : reports)
    out.push_back(
        {{"program", report.program},
         {"subject", report.subject},
         {"state", words(report.state)},
         {"pid", report.pid > 0 ? nlohmann::json(report.pid) : nlohmann::json(nullptr)},
         {"confined", {{"system_calls", report.confinement.system_calls}, {"files", report.confinement.files}}},
         {"memory_bytes", report.memory_bytes},
         {"memory_limit_bytes", report.memory_limit_bytes},
         {"restarts", report.restarts},
         {"last_exit", report.last_exit}});
  return out;
}

void add_processes(web::MetricsText& out, std::span<const SandboxReport> reports) {
  const auto family = [&](std::string_view name, std::string_view kind, std::string_view help, auto value) {
    out.family(name, kind, help);
    for (const SandboxReport& report : reports)
      out.sample(static_cast<double>(value(report)), {{"program", report.program}, {"subject", report.subject}});
  };
  family("cellmirror_process_running", "gauge", "1: the confined process runs; 0: it is away.",
         [](const SandboxReport& report) { return report.pid > 0 ? 1 : 0; });
  family("cellmirror_process_memory_bytes", "gauge", "Resident memory of a confined process.",
         [](const SandboxReport& report) { return report.memory_bytes; });
  family("cellmirror_process_restarts_total", "counter", "Confined processes that ended and were started again.",
         [](const SandboxReport& report) { return report.restarts; });
}

void add_process_problems(Problems& out, std::span<const SandboxReport> reports) {
  for (const SandboxReport& report : reports) {
    if (report.consequence.empty() || report.state != SandboxState::restarting) continue;
    out.push_back({"process", fmt::format("{} ({}) {}: {}; it restarts by itself (restart {})", report.program,
                                          report.subject, report.last_exit, report.consequence, report.restarts)});
  }
}

}  // namespace cellmirror::app
