#include "app/gateway/status_switches.hpp"

#include <nlohmann/json.hpp>

#include "app/gateway/status_collisions.hpp"

namespace cellmirror::app {

using nlohmann::json;

json switches_json(const SwitchPicture& picture, Timestamp now) {
  json last = nullptr;
  if (!picture.last.file.empty()) {
    last = {{"file", picture.last.file},
            {"age_s", seconds(now - picture.last.began)},
            {"running", picture.last.running},
            {"refused_commands", picture.last.refused}};
  }
  return {{"key", picture.key == 0 ? json(nullptr) : json(static_cast<std::uint32_t>(picture.key))},
          {"bytes", picture.bytes},
          {"inputs", picture.inputs},
          {"online", picture.online},
          {"debounce_s", picture.debounce_s},
          {"inputs_on", picture.inputs_on},
          {"edges", picture.edges},
          {"bounces", picture.bounces},
          {"edges_dropped", picture.edges_dropped},
          {"scripts",
           {{"started", picture.scripts.started},
            {"missing", picture.scripts.missing},
            {"refused", picture.scripts.refused},
            {"dropped", picture.scripts.dropped},
            {"with_errors", picture.scripts.with_errors},
            {"waiting", picture.waiting}}},
          {"missing_files", picture.missing_files},
          {"last_script", std::move(last)},
          {"attached", picture.attached},
          {"last_process", picture.last_process == 0 ? json(nullptr) : json(picture.last_process)},
          {"renewed", picture.renewed},
          {"trouble", picture.trouble},
          {"first_command_ms", percentiles_json(picture.first_command, Nanoseconds(1'000'000))}};
}

}  // namespace cellmirror::app
