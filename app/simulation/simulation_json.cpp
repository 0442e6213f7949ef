#include <cmath>
#include <nlohmann/json.hpp>

#include "app/simulation/simulation_report.hpp"
#include "app/simulation/tissue_summary.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

// Keys end in the unit of the joint.
json joint_json(const JointFindings& joint) {
  const bool slides = joint.kind == JointKind::prismatic;
  const std::string unit = slides ? "_m" : "_rad";
  json out = {{"name", joint.name},
              {"moved", joint.moved},
              {"lowest" + unit, joint.lowest},
              {"highest" + unit, joint.highest},
              {"peak_velocity" + unit + "_s", joint.velocity.value},
              {"peak_velocity_time_s", joint.velocity.time_s},
              {"velocity_limit" + unit + "_s", joint.velocity.limit},
              {"velocity_share", joint.velocity_share},
              {"velocity_approached", joint.velocity_approached()},
              {"velocity_violated", joint.velocity_violated()},
              {"peak_acceleration" + unit + "_s2", joint.acceleration.value},
              {"acceleration_limit" + unit + "_s2", joint.acceleration.limit},
              {"acceleration_share", joint.acceleration_share},
              {"range_approached", joint.range_approached()},
              {"range_violated", joint.range_violated()}};
  if (!joint.position) return out;
  out["nearest_limit"] = {{"position" + unit, joint.position->value},
                          {"limit" + unit, joint.position->limit},
                          {"margin_share", joint.range_margin},
                          {"time_s", joint.position->time_s}};
  return out;
}

json robots_json(const SimulationResult& result) {
  json list = json::array();
  for (const RobotFindings& robot : result.robots) {
    json joints = json::array();
    for (const JointFindings& joint : robot.joints) joints.push_back(joint_json(joint));
    list.push_back({{"id", robot.id},
                    {"moved", robot.moved},
                    {"moves", robot.moves},
                    {"moving_s", robot.moving_s},
                    {"held_s", robot.held_s},
                    {"joints", std::move(joints)}});
  }
  return list;
}

json programs_json(const SimulationResult& result) {
  json list = json::array();
  for (const SimulatedProgram& run : result.programs) {
    json out = {{"robot", run.robot}, {"program", run.name}, {"begin_s", run.begin_s},
                {"end_s", run.end_s}, {"end", run.end},      {"duration_s", run.end_s - run.begin_s},
                {"moves", run.moves}};
    if (!run.waits_for.empty()) out["waits_for"] = run.waits_for;
    if (!run.error.empty()) out["error"] = run.error;
    list.push_back(std::move(out));
  }
  return list;
}

json moves_json(const SimulationResult& result) {
  json list = json::array();
  for (const SimulatedMove& move : result.moves) {
    json out = {{"robot", move.robot},     {"id", move.id},       {"kind", move.kind},
                {"begin_s", move.begin_s}, {"end_s", move.end_s}, {"duration_s", move.end_s - move.begin_s},
                {"outcome", move.outcome}};
    if (!move.program.empty()) {
      out["program"] = move.program;
      out["line"] = move.line;
    }
    list.push_back(std::move(out));
  }
  return list;
}

json events_json(const SimulationResult& result) {
  json list = json::array();
  for (const SimulatedEvent& event : result.events) {
    json out = {{"time_s", event.time_s}, {"robot", event.robot}, {"program", event.program}, {"event", event.event}};
    if (event.line != 0) out["line"] = event.line;
    if (!event.text.empty()) out["text"] = event.text;
    list.push_back(std::move(out));
  }
  return list;
}

json messages_json(const SimulationResult& result) {
  json list = json::array();
  for (const SimulatedMessage& message : result.messages)
    list.push_back({{"time_s", message.time_s}, {"text", message.text}});
  return list;
}

json collisions_json(const CollisionSummary& found) {
  json list = json::array();
  for (const SimulatedCollision& c : found.collisions) {
    list.push_back({{"a", c.a},
                    {"b", c.b},
                    {"time_s", c.begin_s},
                    {"parted_s", c.end_s ? json(*c.end_s) : json(nullptr)},
                    {"depth_m", c.depth_m},
                    {"depth_time_s", c.depth_s},
                    {"doubtful", c.doubtful}});
  }
  json out = {{"tested", found.tested},        {"why_not", found.why_not},
              {"period_s", found.period_s},    {"pairs", found.pairs},
              {"tests", found.tests},          {"disagreements", found.disagreements},
              {"wall_s", found.wall_s},        {"warning_distance_m", found.warning_distance_m},
              {"collisions", std::move(list)}, {"not_listed", found.more_collisions},
              {"min_distance", nullptr}};
  if (found.smallest_distance_m) {
    out["min_distance"] = {{"distance_m", number(*found.smallest_distance_m)},
                           {"time_s", found.smallest_distance_s},
                           {"a", found.nearest_a},
                           {"b", found.nearest_b}};
  }
  return out;
}

json refusals_json(const SimulationResult& result) {
  json list = json::array();
  for (const Refusal& refusal : result.refusals) {
    list.push_back({{"time_s", refusal.time_s},
                    {"file", refusal.diagnostic.place.file},
                    {"line", refusal.diagnostic.place.line},
                    {"column", refusal.diagnostic.place.column},
                    {"message", refusal.diagnostic.message},
                    {"remedy", refusal.diagnostic.remedy}});
  }
  return list;
}

}  // namespace

std::string simulation_json(const SimulationResult& result) {
  const json document = {{"cell", result.cell},
                         {"script", result.script},
                         {"end", end_word(result.end)},
                         {"end_note", result.end_note},
                         {"failed", result.failed()},
                         {"simulated_s", result.simulated_s},
                         {"wall_s", result.wall_s},
                         {"processor_s", result.processor_s},
                         {"times_real_time", result.times_real_time()},
                         {"tick_s", result.tick_s},
                         {"ticks", result.ticks},
                         {"script_commands", result.commands},
                         {"programs", programs_json(result)},
                         {"programs_not_listed", result.more_programs},
                         {"moves", moves_json(result)},
                         {"moves_not_listed", result.more_moves},
                         {"events", events_json(result)},
                         {"events_not_listed", result.more_events},
                         {"robots", robots_json(result)},
                         {"deadlocks", result.deadlocks},
                         {"messages", messages_json(result)},
                         {"messages_not_listed", result.more_messages},
                         {"refused", refusals_json(result)},
                         {"refused_not_listed", result.more_refusals},
                         {"collision", collisions_json(result.collision)},
                         {"tissue", tissue_json(result)}};
  return document.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace cellmirror::app
