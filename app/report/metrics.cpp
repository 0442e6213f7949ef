#include "app/report/metrics.hpp"

#include "app/report/metrics_tissue.hpp"
#include "app/report/metrics_volumes.hpp"
#include "app/report/status_processes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace cellmirror::app {

namespace {

void add_loop(MetricsText& out, const LiveSources& sources) {
  out.one("cellmirror_uptime_seconds", "gauge", "Since the start.", sources.uptime_s);
  out.one("cellmirror_loop_rate_hertz", "gauge", "Configured rate of the loop.", sources.rate_hz);
  out.one("cellmirror_loop_ticks_total", "counter", "Periods run.", static_cast<double>(sources.loop.cycles()));
  out.one("cellmirror_loop_missed_total", "counter", "Periods that were skipped because the loop was late.",
          static_cast<double>(sources.loop.missed()));
  out.latency("cellmirror_loop_wakeup_latency_seconds", "How late the loop woke.",
              sources.loop.wakeup_latency().snapshot());
  out.latency("cellmirror_loop_compute_seconds", "How long a tick took.", sources.loop.compute_time().snapshot());
}

// One sample a robot, where `value` has one.
template <class Value>
void for_robots(MetricsText& out, const LiveSources& sources, Value value) {
  for (std::size_t i = 0; i < sources.robots.size() && i < sources.cell_state.robots.size(); ++i) {
    const RobotSnapshot& robot = sources.cell_state.robots[i];
    if (const std::optional<double> found = value(robot, sources.robots[i])) out.sample(*found, {{"robot", robot.id}});
  }
}

template <class Value>
void for_streams(MetricsText& out, const LiveSources& sources, std::string_view name, std::string_view help,
                 Value value) {
  out.family(name, "counter", help);
  for_robots(out, sources, [&](const RobotSnapshot& robot, const RobotState&) -> std::optional<double> {
    if (!robot.stream) return std::nullopt;
    return static_cast<double>(value(robot.stream->status()));
  });
}

void add_robots(MetricsText& out, const LiveSources& sources) {
  out.family("cellmirror_robot_mirrored", "gauge", "1: the robot follows its real one; 0: it is moved by commands.");
  for_robots(out, sources,
             [](const RobotSnapshot&, const RobotState& state) { return std::optional(state.online ? 1.0 : 0.0); });
  out.family("cellmirror_robot_fresh", "gauge", "1: what a mirrored robot shows is fresh.");
  for_robots(out, sources, [](const RobotSnapshot&, const RobotState& state) -> std::optional<double> {
    if (!state.online) return std::nullopt;
    return state.state == DataState::fresh ? 1.0 : 0.0;
  });
  out.family("cellmirror_robot_age_seconds", "gauge", "Since the newest sample of a mirrored robot.");
  for_robots(out, sources, [&](const RobotSnapshot& robot, const RobotState& state) -> std::optional<double> {
    const Timestamp received = sources.tick.robots.at(robot.slot).receive_time;
    if (!state.online || !received.known()) return std::nullopt;
    return seconds(sources.now - received);
  });
  const auto count = [&](std::uint64_t engine::RobotTickHead::* counter) {
    for_robots(out, sources, [&](const RobotSnapshot& robot, const RobotState& state) -> std::optional<double> {
      if (!state.online) return std::nullopt;
      return static_cast<double>(sources.tick.robots.at(robot.slot).*counter);
    });
  };
  out.family("cellmirror_robot_implausible_total", "counter", "Values of a mirrored robot that cannot be true.");
  count(&engine::RobotTickHead::implausible_values);
  out.family("cellmirror_robot_conflicting_total", "counter", "Values of a mirrored robot that two senders give.");
  count(&engine::RobotTickHead::conflicting_values);
  out.family("cellmirror_robot_refused_setpoints_total", "counter", "Steps beyond the limits of a robot, which stood.");
  for_robots(out, sources, [&](const RobotSnapshot& robot, const RobotState&) -> std::optional<double> {
    return static_cast<double>(sources.tick.robots.at(robot.slot).refused_setpoints);
  });
  for_streams(out, sources, "cellmirror_stream_received_total", "Samples received.",
              [](const JointStreamStatus& status) { return status.received; });
  for_streams(out, sources, "cellmirror_stream_lost_total", "Samples known to be missing.",
              [](const JointStreamStatus& status) { return status.lost; });
  for_streams(out, sources, "cellmirror_stream_rejected_total", "Messages or values refused.",
              [](const JointStreamStatus& status) { return status.rejected; });
}

void add_findings(MetricsText& out, const LiveSources& sources) {
  if (sources.proximity) {
    const ProximityState& state = *sources.proximity;
    const auto warned = std::ranges::count(state.near, true, &NearPair::within_warning);
    out.one("cellmirror_pairs_tested", "gauge", "Pairs of bodies that are tested for collision.",
            static_cast<double>(state.pairs));
    out.one("cellmirror_pairs_touching", "gauge", "Pairs of bodies that touch.",
            static_cast<double>(state.touching.size()));
    out.one("cellmirror_pairs_near", "gauge", "Pairs within the warning distance.", static_cast<double>(warned));
    if (state.nearest() != nullptr)
      out.one("cellmirror_nearest_meters", "gauge", "The smallest distance of all tested pairs; 0 where bodies touch.",
              state.nearest()->distance_m);
    out.one("cellmirror_collision_age_seconds", "gauge", "Since the tick for which collisions are known.",
            seconds(sources.now - state.posture_time));
  }
  if (!sources.ranges) return;
  out.family("cellmirror_range_meters", "gauge", "What an ultrasonic sensor reads; +Inf: nothing up to its range.");
  for (const RangeReading& reading : sources.ranges->readings)
    out.sample(reading.distance_m.value_or(HUGE_VAL), {{"sensor", reading.path}});
}

void add_problems(MetricsText& out, std::span<const Problem> problems) {
  out.one("cellmirror_problems", "gauge", "What is wrong around the gateway now: its queues, its guard, its files.",
          static_cast<double>(problems.size()));
  out.family("cellmirror_problem", "gauge", "1 for each kind of problem there is now.");
  std::set<std::string> kinds;
  for (const Problem& problem : problems) kinds.insert(problem.kind);
  for (const std::string& kind : kinds) out.sample(1.0, {{"kind", kind}});
}

void add_alarms(MetricsText& out, const AlarmCounts& alarms) {
  out.family("cellmirror_alarms", "gauge", "Alarms that are active, or that nobody has acknowledged.");
  for (std::size_t i = 0; i < alarms.states.size(); ++i)
    out.sample(static_cast<double>(alarms.states.at(i)), {{"state", kAlarmStateWords.at(i)}});
  out.family("cellmirror_alarms_raised_total", "counter", "Alarms raised since the start.");
  for (std::size_t i = 0; i < alarms.raised.size(); ++i)
    out.sample(static_cast<double>(alarms.raised.at(i)), {{"priority", kAlarmPriorityWords.at(i)}});
  out.one("cellmirror_alarms_not_listed", "gauge", "Conditions for which the list of alarms has no place.",
          static_cast<double>(alarms.not_listed));
}

void add_traffic(MetricsText& out, const LiveSources& sources, const web::ServerStatus& web) {
  out.family("cellmirror_queue_dropped_total", "counter", "Values that a queue between threads refused.");
  for (const engine::QueueStatus& queue : sources.queues)
    out.sample(static_cast<double>(queue.dropped), {{"queue", queue.name}});
  out.family("cellmirror_queue_passed_total", "counter", "Values that went into a queue between threads.");
  for (const engine::QueueStatus& queue : sources.queues)
    out.sample(static_cast<double>(queue.passed), {{"queue", queue.name}});
  if (sources.outputs) {
    out.family("cellmirror_output", "gauge", "What an output counts, as queues[] of status has it.");
    for (const auto& [name, counters] : sources.outputs()) {
      for (const auto& [counter, value] : counters)
        out.sample(static_cast<double>(value), {{"output", name}, {"counter", counter}});
    }
  }
  const script::SourceCounters script = sources.cell_state.script.all();
  out.one("cellmirror_script_done_total", "counter", "SCRIPT commands carried out.", static_cast<double>(script.done));
  out.one("cellmirror_script_refused_total", "counter", "SCRIPT commands refused.",
          static_cast<double>(script.refused));
  out.one("cellmirror_page_clients", "gauge", "Monitor pages that are open.", static_cast<double>(web.clients));
  out.one("cellmirror_page_requests_total", "counter", "HTTP requests.", static_cast<double>(web.requests));
  out.one("cellmirror_page_refused_total", "counter", "Requests and messages refused.",
          static_cast<double>(web.refused));
  out.one("cellmirror_page_wrong_tokens_total", "counter", "Wrong tokens that clients of the page have sent.",
          static_cast<double>(web.wrong_tokens));
  out.one("cellmirror_page_unread_tokens_total", "counter",
          "Tokens refused without a check, because their sender had sent too many wrong ones.",
          static_cast<double>(web.unread_tokens));
  out.one("cellmirror_page_cut_total", "counter", "Connections ended for being too slow or silent.",
          static_cast<double>(web.cut));
  out.one("cellmirror_page_commands_total", "counter", "Commands from monitor pages.",
          static_cast<double>(web.commands));
  out.one("cellmirror_pictures_sent_total", "counter", "Pictures sent to monitor pages.",
          static_cast<double>(web.pictures));
  out.one("cellmirror_pictures_left_out_total", "counter", "Pictures that came while a page was not ready for them.",
          static_cast<double>(web.pictures_left_out));
}

}  // namespace

std::string metrics_document(const LiveSources& sources, const web::ServerStatus& web) {
  MetricsText out;
  out.family("cellmirror_info", "gauge", "Which gateway this is.");
  out.sample(1, {{"version", CELLMIRROR_VERSION}, {"instance", sources.instance}, {"cell", sources.cell}});
  add_loop(out, sources);
  add_processes(out, sandbox_reports());
  add_robots(out, sources);
  add_findings(out, sources);
  add_tissue_metrics(out, sources);
  add_volume_metrics(out, sources);
  add_problems(out, sources.problems);
  add_alarms(out, sources.alarms);
  add_traffic(out, sources, web);
  return out.take();
}

}  // namespace cellmirror::app
