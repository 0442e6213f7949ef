#include "app/report/status_commands.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace cellmirror::app {

nlohmann::json command_log_json(const CommandLogReport& report) {
  using nlohmann::json;
  json last = json::array();
  for (const std::string& line : report.last) last.push_back(json::parse(line, nullptr, /*allow_exceptions=*/false));
  return {{"file", report.file}, {"written", report.written}, {"dropped", report.dropped}, {"last", std::move(last)}};
}

std::string command_log_document(const CommandLogReport& report) {
  return command_log_json(report).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace cellmirror::app
