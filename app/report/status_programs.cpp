#include "app/report/status_programs.hpp"

#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

json program_json(const program::ProgramStatus& status) {
  return {{"robot", status.robot},
          {"program", status.name},
          {"language", status.language},
          {"file", status.file},
          {"state", program::name_of(status.state)},
          {"waits_for", status.waits_for},
          {"step", status.step},
          {"line", status.line},
          {"statements", status.statements},
          {"reversible", status.reversible},
          {"direction", status.direction == program::Direction::backward ? "backward" : "forward"},
          {"elapsed_s", status.elapsed_s},
          {"expected_s", status.expected_s ? json(*status.expected_s) : json(nullptr)},
          {"runs", status.runs},
          {"error", status.error}};
}

json deadlock_json(const std::optional<program::Deadlock>& deadlock) {
  if (!deadlock) return nullptr;
  json waiting = json::array();
  for (const program::Deadlock::Waiting& program : deadlock->waiting) {
    waiting.push_back({{"robot", program.robot},
                       {"program", program.program},
                       {"step", program.step},
                       {"semaphore", program.semaphore},
                       {"releasers", program.releasers},
                       {"not_started", program.not_started},
                       {"kept_by", program.kept_by}});
  }
  return {{"text", deadlock->text()}, {"waiting", std::move(waiting)}};
}

json analogue_json(const std::vector<std::pair<std::size_t, double>>& values) {
  json all = json::array();
  for (const auto& [number, value] : values) all.push_back({{"number", number}, {"value", value}});
  return all;
}

}  // namespace

json programs_json(const ProgramsSnapshot& programs) {
  json all = json::array();
  for (const program::ProgramStatus& status : programs.programs) all.push_back(program_json(status));
  json semaphores = json::object();
  for (const auto& [name, count] : programs.semaphores) semaphores[name] = count;
  json signals = json::array();
  for (const SignalSnapshot& robot : programs.signals) {
    signals.push_back({{"robot", robot.robot},
                       {"inputs_on", robot.inputs_on},
                       {"outputs_on", robot.outputs_on},
                       {"analogue_inputs", analogue_json(robot.analogue_inputs)},
                       {"analogue_outputs", analogue_json(robot.analogue_outputs)}});
  }
  json recordings = json::array();
  for (const RecordingSnapshot& recording : programs.recordings) {
    recordings.push_back({{"robot", recording.robot},
                          {"program", recording.program},
                          {"language", recording.language},
                          {"points", recording.points}});
  }
  json loading = json::array();
  for (const LoadSnapshot& load : programs.loading) {
    loading.push_back({{"robot", load.robot}, {"program", load.program}});
  }
  return {{"loaded", std::move(all)},
          {"loading", std::move(loading)},
          {"deadlock", deadlock_json(programs.deadlock)},
          {"semaphores", std::move(semaphores)},
          {"signals", std::move(signals)},
          {"recordings", std::move(recordings)},
          {"failures", programs.failures},
          {"last_failure", programs.last_failure}};
}

}  // namespace cellmirror::app
