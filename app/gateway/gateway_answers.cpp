// What a running gateway answers: status, the page's news, requests of the control socket.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "app/gateway/gateway_parts.hpp"
#include "app/gateway/host_name.hpp"
#include "app/gateway/node_fault_request.hpp"
#include "app/gateway/playback_request.hpp"
#include "app/pictures/snapshot_request.hpp"
#include "app/report/cell_summary_builder.hpp"
#include "app/report/loop_health.hpp"
#include "app/report/playback_document.hpp"
#include "app/report/status_document.hpp"
#include "app/report/status_processes.hpp"
#include "ipc/control/queue_answer.hpp"
#include "ipc/sysv/force_guard.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/wall_clock.hpp"

namespace cellmirror::app {

void Gateway::Parts::answer(std::string_view line, ControlReply reply) {
  const Result<ControlRequest> request = parse_control_request(line);
  if (!request) return reply(control_error(request.error()));
  if (request->request == "status") return reply(status());
  if (request->request == "snapshot") return answer_snapshot(*request, std::move(reply));
  if (request->request == "queues") return answer_queues(std::move(reply));
  if (request->request == "playback") return answer_playback(*request, std::move(reply));
  if (request->request == "record" && playback != nullptr)
    return reply(control_error({"this is a replay: it is recorded already", "copy the file that is played"}));
  if (request->request == "record") return reply(recordings.answer(*request));
  if (request->request == "fault") {
    const Result<void> injected = inject(*request);
    return reply(injected ? R"({"done":true})" : control_error(injected.error()));
  }
  reply(control_error({fmt::format("the request {} is not known", request->request),
                       "known: status, snapshot, queues, record, playback, fault"}));
}

namespace {

// The nodes that answer at this moment.
std::vector<const FaultTarget*> targets_of(const CellState& cell_state, const FaultRequest& wanted) {
  std::vector<const FaultTarget*> found;
  const auto add = [&](const FaultTarget* target) {
    if (target == nullptr || (!wanted.channel.empty() && target->channel != wanted.channel)) return;
    if (std::ranges::find(target->nodes, wanted.order.node) != target->nodes.end()) found.push_back(target);
  };
  for (const RobotSnapshot& robot : cell_state.robots) {
    if (robot.online) add(robot.faults.get());
  }
  for (const IoNodeSnapshot& node : cell_state.io_nodes) {
    if (node.trouble.empty()) add(node.faults.get());
  }
  return found;
}

}  // namespace

// By the thread of the control socket, which alone orders faults.
Result<void> Gateway::Parts::inject(const ControlRequest& request) {
  const Result<FaultRequest> wanted = fault_request(request);
  if (!wanted) return std::unexpected(wanted.error());
  const NodeFaultOrder& order = wanted->order;
  const std::shared_ptr<const CellState> cell_state = board.latest();
  const auto targets = targets_of(*cell_state, *wanted);
  if (targets.empty())
    return fail(fmt::format("no node {} answers a controller", order.node),
                "nodes are those of [[device]], while its robot is online, and of [[io_node]]");
  if (targets.size() > 1)
    return fail(fmt::format("several nodes have the number {}", order.node),
                "name the channel, e.g. --channel socketcan:can0");
  const FaultTarget& target = *targets.front();
  if (!order.ends_all && order.fault.kind == NodeFaultKind::stuck && !target.robot.empty())
    return fail(fmt::format("node {} is a drive; inputs of I/O nodes get stuck", order.node));
  if (!target.inlet->push(order)) return fail("too many faults wait already", "try it again");
  log_warning("node-fault", "node {} on {}: {}", order.node, target.channel,
              order.ends_all ? "all injected faults end" : "a fault is injected: " + *request.argument("fault"));
  return {};
}

// {"request":"playback", "play":true, "speed":2, "seek_s":1.5}: seconds after the beginning of the range.
void Gateway::Parts::answer_playback(const ControlRequest& request, ControlReply reply) {
  if (playback == nullptr) return reply(control_error({"this gateway plays no recording", "cellmirror replay does"}));
  const auto wanted = playback_request(request, playback->control().state());
  if (!wanted) return reply(control_error(wanted.error()));
  if (auto done = playback->control().apply(*wanted); !done) return reply(control_error(done.error()));
  reply(playback_document(playback->control().state()));
}

void Gateway::Parts::answer_queues(ControlReply reply) {
  if (playback != nullptr)
    return reply(control_error({"this is a replay: it takes no SCRIPT messages",
                                "views are set on its page: cellmirror replay F.mcap --page"}));
  const ScriptMessageStatus status = messages->status();
  reply(queue_answer_text({status.input_queue, status.reply_queue, status.input_problem, status.reply_problem}));
}

void Gateway::Parts::answer_snapshot(const ControlRequest& request, ControlReply reply) {
  const auto wanted = snapshot_request(request);
  if (!wanted) return reply(control_error(wanted.error()));
  const PictureSettings& settings = renderer->settings();
  // A function that is copied holds what can be moved only.
  const auto later = std::make_shared<ControlReply>(std::move(reply));
  renderer->ask_picture(picture_request_of(*wanted, settings.width, settings.height), wanted->format,
                        [this, later](const Result<EncodedImage>& picture) {
                          if (!picture) return (*later)(control_error(picture.error()));
                          (*later)(answer_text(*picture, seconds(clock.now() - picture->posture_time)));
                        });
}

std::vector<engine::QueueStatus> Gateway::Parts::thread_queues(const CellState& cell_state) const {
  std::vector<engine::QueueStatus> queues_now{engine->command_queue(), owner->command_queue()};
  for (const RobotSnapshot& robot : cell_state.robots) {
    if (!robot.stream) continue;
    queues_now.push_back(engine->sample_queue(robot.slot));
    queues_now.back().name = "samples " + robot.id;
  }
  return queues_now;
}

void Gateway::Parts::look_at(const std::function<void(const LiveSources&)>& look) {
  const std::shared_ptr<const CellState> cell_state = board.latest();
  const std::vector<engine::QueueStatus> queues_now = thread_queues(*cell_state);
  const Problems problems_now = problems();
  const std::uint64_t commands_logged = commands ? commands->count() : 0;
  const std::scoped_lock lock(answering);
  const engine::TickState& tick = readers->status.newest();
  const std::span<const RobotState> robots = status_builder.build(*cell_state, tick);
  const Timestamp now = clock.now();
  look({instance->info().name,
        cell_name,
        seconds(machine_clock.now() - started),
        loop_settings.rate_hz,
        now,
        *loop,
        *cell_state,
        tick,
        robots,
        status_builder.poses(),
        picture_counter.count(),
        collisions->board().latest(),
        ranging->board().latest(),
        forces->board().latest(),
        queues_now,
        problems_now,
        commands_logged,
        tissue_sources().newest_report(),
        renderer->counters(),
        playback != nullptr ? alarm_report().counts : alarms->counts(),
        playback_state(),
        [this] { return output_counters(); }});
}

namespace {

// Lists each missing network interface with the streams and I/O nodes that wait for it: "waits for can0 (robot A, I/O
// node 7); ...".
std::string missing_interfaces(const CellState& cell) {
  std::map<std::string, std::vector<std::string>> waiting;
  std::map<std::string, std::string> reasons;
  const auto look = [&](const JointStream& stream, std::string name) {
    const JointStreamStatus status = stream.status();
    if (status.waits_for.empty()) return;
    waiting[status.waits_for].push_back(std::move(name));
    reasons[status.waits_for] = status.condition;
  };
  for (const RobotSnapshot& robot : cell.robots) {
    if (robot.stream) look(*robot.stream, "robot " + robot.id);
  }
  for (const IoNodeSnapshot& node : cell.io_nodes) {
    if (node.stream) look(*node.stream, fmt::format("I/O node {}", node.config->node_id));
  }
  std::string out;
  for (const auto& [missing, names] : waiting) {
    out += fmt::format("{}{} ({})", out.empty() ? "" : "; ", reasons[missing], fmt::join(names, ", "));
  }
  return out;
}

}  // namespace

Problems Gateway::Parts::problems() const {
  Problems out;
  const auto add = [&](const char* kind, std::string text) {
    if (!text.empty()) out.push_back({kind, std::move(text)});
  };
  const ScriptMessageStatus status = messages->status();
  add("script_queue", status.input_problem);
  add("reply_queue", status.reply_problem);
  add("command_log", commands ? commands->report().problem : commands_problem);
  add("alarm_log", alarms->problem());
  add("recording", recordings.hub().problem());
  for (const PublishedOutput& output : publisher->outputs()) add("sensor_queue", output.output->problem());
  if (summaries) {
    for (const auto& output : summaries->outputs()) add("summary", output->problem());
  }
  if (mqtt) add("mqtt", mqtt->problem());
  add_process_problems(out, sandbox_reports());
  if (const auto cell = board.latest()) add("stream", missing_interfaces(*cell));
  if (playback == nullptr && (guard == nullptr || !guard->running())) {
    add("force_guard", fmt::format("the process that removes the forces of a killed gateway from shared memory {}; "
                                   "restart the gateway",
                                   guard == nullptr ? "could not be started (see the log)" : "was ended"));
  }
  return out;
}

web::Health Gateway::Parts::health() {
  if (playback != nullptr) return {true, "ok"};
  const std::scoped_lock lock(answering);
  const Timestamp newest = readers->status.newest().time;
  return loop_health(clock.now() - newest, kLoopStandsStillAfter, faults->status());
}

CellSummary Gateway::Parts::summary() {
  SummaryFacts facts{.host = host_name(), .run = run, .loop = health(), .page_port = page->port()};
  if (faults) facts.faults = faults->status().faults;
  facts.time_ns = machine_wall_clock_ns(machine_clock.now());
  CellSummary out;
  look_at([&](const LiveSources& sources) { out = summary_of(sources, facts); });
  return out;
}

OutputCounters Gateway::Parts::output_counters() const {
  OutputCounters out;
  for (const PublishedOutput& output : publisher->outputs())
    out.emplace_back(output.output->name(), output.output->counters());
  if (summaries) {
    for (const auto& output : summaries->outputs()) out.emplace_back(output->name(), output->counters());
  }
  for (const ImageOutput* output : renderer->outputs()) out.emplace_back(output->name(), output->counters());
  return out;
}

std::string Gateway::Parts::status() {
  const std::shared_ptr<const CellState> cell_state = board.latest();
  const std::scoped_lock lock(answering);
  const engine::TickState& tick = readers->status.newest();
  const FaultStatus fault_status = faults ? faults->status() : FaultStatus();
  const ScriptMessageStatus message_status = messages->status();
  const CollisionReport collision_report = collisions->report();
  const RangeReport range_report = ranging->report();
  const ContactReport contact_report = contacts->report();
  const ForceReport force_report = forces->report();
  const RenderReport render_report = renderer->report();
  PageReport page_report = page->report();
  page_report.live = recordings.live().feed().status();
  const Timestamp now = clock.now();
  return status_document({instance->info().name,
                          cell_name,
                          home->root().string(),
                          seconds(machine_clock.now() - started),
                          loop_settings.rate_hz,
                          now,
                          *loop,
                          memory,
                          fault_status,
                          *cell_state,
                          tick,
                          status_builder.build(*cell_state, tick),
                          message_status,
                          collision_report,
                          range_report,
                          contact_report,
                          force_report,
                          render_report,
                          page_report,
                          thread_queues(*cell_state),
                          output_counters(),
                          problems(),
                          {guard != nullptr && guard->running(), guard != nullptr ? guard->process() : 0},
                          command_log(),
                          tissue_sources().newest_report(),
                          recordings.hub().reports(),
                          alarm_report(),
                          playback_state()});
}

}  // namespace cellmirror::app
