#include "app/report/status_switches.hpp"

#include <nlohmann/json.hpp>

#include "app/report/status_collisions.hpp"

namespace cellmirror::app {

using nlohmann::json;

json switches_json(const FootSwitchSnapshot& snapshot, Timestamp now) {
  json last = nullptr;
  if (!snapshot.last.file.empty()) {
    last = {{"file", snapshot.last.file},
            {"age_s", seconds(now - snapshot.last.began)},
            {"running", snapshot.last.running},
            {"refused_commands", snapshot.last.refused}};
  }
  return {{"key", snapshot.key == 0 ? json(nullptr) : json(static_cast<std::uint32_t>(snapshot.key))},
          {"bytes", snapshot.bytes},
          {"inputs", snapshot.inputs},
          {"online", snapshot.online},
          {"debounce_s", snapshot.debounce_s},
          {"inputs_on", snapshot.inputs_on},
          {"edges", snapshot.edges},
          {"bounces", snapshot.bounces},
          {"edges_dropped", snapshot.edges_dropped},
          {"scripts",
           {{"started", snapshot.scripts.started},
            {"missing", snapshot.scripts.missing},
            {"refused", snapshot.scripts.refused},
            {"dropped", snapshot.scripts.dropped},
            {"with_errors", snapshot.scripts.with_errors},
            {"waiting", snapshot.waiting}}},
          {"missing_files", snapshot.missing_files},
          {"last_script", std::move(last)},
          {"attached", snapshot.attached},
          {"last_process", snapshot.last_process == 0 ? json(nullptr) : json(snapshot.last_process)},
          {"renewed", snapshot.renewed},
          {"trouble", snapshot.trouble},
          {"first_command_ms", percentiles_json(snapshot.first_command, Nanoseconds(1'000'000))}};
}

}  // namespace cellmirror::app
