#include "app/report/status_document.hpp"
#include "app/report/playback_document.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "app/report/implausible_values.hpp"
#include "app/report/status_alarms.hpp"
#include "app/report/status_collisions.hpp"
#include "app/report/status_commands.hpp"
#include "app/report/status_controllers.hpp"
#include "app/report/status_couplings.hpp"
#include "app/report/status_display.hpp"
#include "app/report/status_forces.hpp"
#include "app/report/status_haptics.hpp"
#include "app/report/status_io.hpp"
#include "app/report/status_page.hpp"
#include "app/report/status_pictures.hpp"
#include "app/report/status_processes.hpp"
#include "app/report/status_programs.hpp"
#include "app/report/status_ranges.hpp"
#include "app/report/status_recordings.hpp"
#include "app/report/status_switches.hpp"
#include "app/report/status_tissue.hpp"
#include "app/report/status_values.hpp"
#include "app/report/status_volumes.hpp"
#include "app/snapshot/joint_range.hpp"
#include "rt_core/motion/move_words.hpp"
#include "rt_core/ports/words.hpp"
#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::size_t kMostAlarms = 100;

std::string note(const std::string& why_not, const std::string& remedy) {
  return why_not.empty() || remedy.empty() ? why_not : why_not + "; " + remedy;
}

json loop_json(const StatusSources& sources) {
  const SchedulingOutcome& scheduling = sources.loop.scheduling();
  const std::string priority = scheduling.priority > 0 ? fmt::format(" {}", scheduling.priority) : std::string();
  return {{"rate_hz", sources.rate_hz},
          {"scheduler", scheduling.scheduler + priority},
          {"scheduler_note", note(scheduling.why_not, scheduling.remedy)},
          {"memory_locked", sources.memory.level == MemoryLockLevel::all},
          {"memory_note", note(sources.memory.why_not, sources.memory.remedy)},
          {"ticks", sources.loop.cycles()},
          {"missed", sources.loop.missed()},
          {"wakeup_latency_us", percentiles_us(sources.loop.wakeup_latency().snapshot())},
          {"compute_us", percentiles_us(sources.loop.compute_time().snapshot())},
          {"allocations", AllocationGuard::armed() ? json(sources.loop.heap_calls()) : json(nullptr)},
          {"faults", sources.faults.faults},
          {"fault_latched", sources.faults.latched},
          {"last_fault", sources.faults.last}};
}

json stream_json(const RobotSnapshot& robot, const engine::RobotTickState& tick, const RobotState& state,
                 Timestamp now) {
  if (!robot.stream) {
    return {{"kind", "none"},
            {"endpoint", ""},
            {"state", "off"},
            {"age_s", nullptr},
            {"rate_hz", 0.0},
            {"received", 0},
            {"lost", 0},
            {"rejected", 0},
            {"condition", "not opened"},
            {"details", json::object()},
            {"last_errors", json::array()}};
  }
  const JointStreamStatus status = robot.stream->status();
  json details = json::object();
  for (const auto& [key, value] : status.details) details[key] = value;
  return {{"kind", status.kind},
          {"endpoint", status.endpoint},
          {"state", robot.online ? word(tick.state) : "off"},
          {"age_s", age_json(now, tick.receive_time)},
          {"rate_hz", status.rate_hz},
          {"received", status.received},
          {"lost", status.lost},
          {"rejected", status.rejected},
          {"condition", condition_text(tick, state, status.condition)},
          {"details", std::move(details)},
          {"last_errors", status.last_errors}};
}

json why_json(Implausibility why) { return why == Implausibility::none ? json() : json(word(why)); }

json plausibility_json(const engine::RobotTickState& tick, const RobotState& state, Timestamp now) {
  const ImplausibleValue& newest = tick.newest_implausible;
  json found = nullptr;
  if (newest.why != Implausibility::none && newest.joint < state.joints.size()) {
    found = {{"joint", state.joints[newest.joint].name},
             {"why", word(newest.why)},
             {"value", newest.value},
             {"bound", newest.bound},
             {"age_s", age_json(now, newest.receive_time)}};
  }
  return {{"implausible_values", tick.implausible_values},
          {"conflicting_values", tick.conflicting_values},
          {"newest", std::move(found)}};
}

json joints_json(const RobotState& robot, const RobotParameters& parameters, Timestamp now) {
  json out = json::array();
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const RobotJointState& joint = robot.joints[i];
    const double lower = parameters.min_range[i];
    const double upper = parameters.max_range[i];
    out.push_back({{"name", joint.name},
                   {"position", joint.position},
                   {"unit", joint.kind == JointKind::prismatic ? "m" : "rad"},
                   {"velocity", joint.velocity},
                   {"effort", joint.effort},
                   {"range", {lower, upper}},
                   {"beyond_range", is_beyond(joint.position, lower, upper)},
                   {"state", word(joint.state)},
                   {"implausible", why_json(joint.implausible)},
                   {"age_s", age_json(now, joint.receive_time)}});
  }
  return out;
}

json pose_json(const Pose& X) {
  const Eigen::Quaterniond q(X.linear());
  return {{"position_m", {X.translation().x(), X.translation().y(), X.translation().z()}},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

json parameters_json(const RobotParameters& p, std::size_t joints) {
  const auto list = [joints](const JointValues& values) {
    return json(std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(joints)));
  };
  return {{"max_range", list(p.max_range)},
          {"min_range", list(p.min_range)},
          {"start_position", list(p.start_position)},
          {"reference_position", list(p.reference_position)},
          {"max_velocity", list(p.max_velocity)},
          {"min_velocity", list(p.min_velocity)},
          {"active_velocity", list(p.active_velocity)},
          {"max_acceleration", list(p.max_acceleration)},
          {"active_acceleration", list(p.active_acceleration)},
          {"requested",
           {{"start_position", list(p.requested.start_position)},
            {"active_velocity", list(p.requested.active_velocity)},
            {"active_acceleration", list(p.requested.active_acceleration)}}},
          {"linear_velocity_m_s", p.linear_velocity},
          {"linear_acceleration_m_s2", p.linear_acceleration},
          {"rotational_velocity_rad_s", p.rotational_velocity},
          {"rotational_acceleration_rad_s2", p.rotational_acceleration},
          {"velocity_scale", p.velocity_scale},
          {"acceleration_scale", p.acceleration_scale},
          {"fly_type", static_cast<int>(p.fly_type)},
          {"fly_parameter", p.fly_parameter},
          {"program_delay_s", p.program_delay_s},
          {"ptp_mode", p.ptp_mode == PtpMode::synchronous ? "sync" : "async"},
          {"velocity_profile", p.velocity_profile == VelocityProfile::sine ? "sine" : "ramp"},
          {"inverse_class", word(p.inverse_class)},
          {"point_of_reference", pose_json(p.X_FP)},
          {"tool_center_point", pose_json(p.X_PT)}};
}

json motion_json(const RobotSnapshot& robot_snapshot, const motion::MotionState& motion, std::size_t joints) {
  json target = nullptr;
  if (robot_snapshot.target) {
    const auto end = robot_snapshot.target->begin() + static_cast<std::ptrdiff_t>(joints);
    target = std::vector<double>(robot_snapshot.target->begin(), end);
  }
  return {{"moving", motion.moving},
          {"running", motion.running},
          {"waiting", motion.waiting},
          {"finished", motion.finished},
          {"outcome", word(motion.outcome)},
          {"target", std::move(target)},
          {"positioning", robot_snapshot.positioning == Positioning::jumping ? "jump" : "move"}};
}

json robots_json(const StatusSources& sources) {
  json out = json::array();
  for (std::size_t i = 0; i < sources.robots.size() && i < sources.cell_state.robots.size(); ++i) {
    const RobotSnapshot& robot_snapshot = sources.cell_state.robots[i];
    const RobotState& state = sources.robots[i];
    const engine::RobotTickState& tick = sources.tick.robots[robot_snapshot.slot];
    out.push_back({{"id", robot_snapshot.id},
                   {"mode", robot_mode_word(state.online)},
                   {"active", robot_snapshot.id == sources.cell_state.active_robot},
                   {"sending", robot_snapshot.sending},
                   {"stream", stream_json(robot_snapshot, tick, state, sources.now)},
                   {"joints", joints_json(state, robot_snapshot.parameters, sources.now)},
                   {"tcp", pose_json(state.X_WT)},
                   {"motion", motion_json(robot_snapshot, tick.motion, state.joints.size())},
                   {"parameters", parameters_json(robot_snapshot.parameters, state.joints.size())},
                   {"refused_values", tick.refused_values},
                   {"refused_setpoints", tick.refused_setpoints},
                   {"plausibility", plausibility_json(tick, state, sources.now)}});
  }
  return out;
}

json script_json(const StatusSources& sources) {
  const script::SourceCounters all = sources.cell_state.script.all();
  json runs = json::array();
  for (const script::RunStatus& run : sources.cell_state.runs) {
    runs.push_back({{"id", run.id}, {"stack", run.stack}, {"waiting", run.waiting}});
  }
  const ScriptMessageStatus& messages = sources.messages;
  // A message that is no SCRIPT at all was received and refused too, before the interpreter saw it.
  return {{"received", all.received + messages.malformed},
          {"done", all.done},
          {"refused", all.refused + messages.malformed},
          {"running", sources.cell_state.runs.size()},
          {"runs", std::move(runs)},
          {"language", sources.cell_state.language},
          {"last_errors", sources.cell_state.script_errors},
          {"last_malformed", messages.last_errors}};
}

json queues_json(const StatusSources& sources) {
  json out = json::array();
  for (const engine::QueueStatus& queue : sources.queues) {
    out.push_back({{"name", queue.name},
                   {"capacity", queue.capacity},
                   {"high_water", queue.high_water},
                   {"passed", queue.passed},
                   {"dropped", queue.dropped}});
  }
  const ScriptMessageStatus& m = sources.messages;
  out.push_back({{"name", "script messages"},
                 {"passed", m.received},
                 {"waiting", m.waiting},
                 {"dropped", m.malformed + m.wrong_type + m.discarded},
                 {"wrong_type", m.wrong_type},
                 {"discarded", m.discarded},
                 {"recreated", m.recreated},
                 {"queue", m.input_queue},
                 {"problem", m.input_problem}});
  out.push_back({{"name", "script replies"},
                 {"passed", m.replies},
                 {"dropped", m.replies_dropped},
                 {"queue", m.reply_queue},
                 {"problem", m.reply_problem}});
  for (const auto& [name, counters] : sources.outputs) {
    json queue = {{"name", name}, {"dropped", 0}};
    for (const auto& [key, value] : counters) queue[key] = value;
    out.push_back(std::move(queue));
  }
  return out;
}

json problems_json(const Problems& problems) {
  json out = json::array();
  for (const Problem& problem : problems) out.push_back({{"kind", problem.kind}, {"text", problem.text}});
  return out;
}

json messages_json(const StatusSources& sources) {
  json out = json::array();
  for (const ShownText& message : sources.cell_state.display->messages) {
    out.push_back({{"text", message.text}, {"age_s", age_json(sources.now, message.time)}});
  }
  return out;
}

json cameras_json(const CompiledCell& cell) {
  json out = json::array();
  for (const CompiledCamera& camera : cell.cameras) {
    out.push_back({{"id", camera.name}, {"focal_distance_m", camera.focal_distance_m}, {"fovy_rad", camera.fovy_rad}});
  }
  return out;
}

}  // namespace

std::string status_document(const StatusSources& sources) {
  const CompiledCell& cell = *sources.cell_state.cell;
  const auto visible = std::count(cell.visible.begin(), cell.visible.end(), std::uint8_t{1});
  const json document = {
      {"version", CELLMIRROR_VERSION},
      {"instance", sources.instance},
      {"pid", getpid()},
      {"cell", sources.cell},
      {"home", sources.home},
      {"uptime_s", sources.uptime_s},
      {"problems", problems_json(sources.problems)},
      {"alarms", alarms_json(sources.alarms, sources.now, kMostAlarms)},
      {"force_guard", {{"running", sources.force_guard.running}, {"process", sources.force_guard.process}}},
      {"loop", loop_json(sources)},
      {"robots", robots_json(sources)},
      {"script", script_json(sources)},
      {"queues", queues_json(sources)},
      {"command_log", command_log_json(sources.commands)},
      {"messages", messages_json(sources)},
      {"cameras", cameras_json(cell)},
      {"display", display_json(*sources.cell_state.display, sources.now)},
      {"collisions", collisions_json(sources.collisions, sources.now)},
      {"ranges", ranges_json(sources.ranges, sources.cell_state, sources.now)},
      {"haptics", haptics_json(sources.cell_state, sources.tick, sources.contacts, sources.now)},
      {"forces", forces_json(sources.forces, sources.cell_state.forces, sources.now)},
      {"pictures", pictures_json(sources.pictures)},
      {"page", page_json(sources.page)},
      {"programs", programs_json(sources.cell_state.programs)},
      {"foot_switches", switches_json(sources.cell_state.switches, sources.now)},
      {"io_nodes", io_nodes_json(sources.cell_state)},
      {"controllers", controllers_json(sources.cell_state.controllers, sources.tick, sources.now)},
      {"couplings", couplings_json(sources.cell_state.couplings, sources.tick)},
      {"tissue", tissue_json(sources.tissue, sources.cell_state, sources.now)},
      {"volumes", volumes_json(sources.cell_state)},
      {"recordings", recordings_json(sources.recordings)},
      {"processes", processes_json(sandbox_reports())},
      {"replay", sources.playback ? json::parse(playback_document(*sources.playback)) : json(nullptr)},
      {"cell_tree", {{"revision", cell.revision}, {"nodes", cell.size()}, {"visible", visible}}}};
  // Text from outside (names, messages) may hold bytes that are no UTF-8.
  return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace cellmirror::app
