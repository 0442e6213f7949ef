#include "app/report/live_document.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "app/report/implausible_values.hpp"
#include "app/report/live_tissue.hpp"
#include "app/report/live_volumes.hpp"
#include "app/report/playback_document.hpp"
#include "app/snapshot/haptic_names.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/microseconds.hpp"
#include "rt_core/ports/words.hpp"
#include "rt_core/scene/panes.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kMostPairs = 50;  // touching, and near: keeps the document small
constexpr std::size_t kMostPrograms = 50;

std::string_view unit(JointKind kind) { return kind == JointKind::prismatic ? "m" : "rad"; }

std::optional<double> age_s(Timestamp now, Timestamp then) {
  return then.known() ? std::optional(seconds(now - then)) : std::nullopt;
}

void add_joints(JsonWriter& out, const RobotState& robot, const CompiledRobot* compiled) {
  out.key("joints").begin_array();
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const RobotJointState& joint = robot.joints[i];
    const bool limited = compiled != nullptr && joint.kind != JointKind::continuous && i < kMaxJointsPerRobot &&
                         compiled->min_range.at(i) < compiled->max_range.at(i);
    out.begin_object()
        .member("name", joint.name)
        .member("kind", word(joint.kind))
        .member("unit", unit(joint.kind))
        .member("position", joint.position)
        .member("velocity", joint.velocity)
        .member("state", word(joint.state))
        .member("lower", limited ? std::optional(compiled->min_range.at(i)) : std::nullopt)
        .member("upper", limited ? std::optional(compiled->max_range.at(i)) : std::nullopt)
        .end_object();
  }
  out.end_array();
}

// The fault of the haptic device that drives the robot, with its remedy; without one the condition of its stream.
std::string condition_of(const LiveSources& sources, const RobotSnapshot& robot, const RobotState& state) {
  for (const HapticSnapshot& haptic : sources.cell_state.haptics) {
    if (haptic.robot != robot.id || !haptic.online) continue;
    if (std::string fault = fault_text(sources.tick.haptics.at(haptic.channel), robot.id); !fault.empty()) return fault;
  }
  const std::string of_stream = robot.stream ? robot.stream->status().condition : std::string();
  return condition_text(sources.tick.robots.at(robot.slot), state, of_stream);
}

void add_robots(JsonWriter& out, const LiveSources& sources) {
  out.key("robots").begin_array();
  for (std::size_t i = 0; i < sources.robots.size() && i < sources.cell_state.robots.size(); ++i) {
    const RobotSnapshot& robot_snapshot = sources.cell_state.robots[i];
    const RobotState& state = sources.robots[i];
    const engine::RobotTickState& tick = sources.tick.robots.at(robot_snapshot.slot);
    out.begin_object()
        .member("id", robot_snapshot.id)
        .member("mode", robot_mode_word(state.online))
        .member("state", state.online ? word(state.state) : "off")
        .member("age_s", state.online ? age_s(sources.now, tick.receive_time) : std::nullopt)
        .member("active", robot_snapshot.id == sources.cell_state.active_robot)
        .member("moving", tick.motion.moving)
        .member("refused_setpoints", tick.refused_setpoints)
        .member("condition", condition_of(sources, robot_snapshot, state));
    add_joints(out, state, sources.cell_state.cell->robot(robot_snapshot.slot));
    out.end_object();
  }
  out.end_array();
}

void add_loop(JsonWriter& out, const LiveSources& sources, const LoopWindow::Figures& figures) {
  out.key("loop")
      .begin_object()
      .member("rate_hz", sources.rate_hz)
      .member("latency_p99_us", figures.latency_p99_us)
      .member("compute_p99_us", figures.compute_p99_us)
      .member("missed", sources.loop.missed())
      .end_object();
}

std::string_view body_name(const ProximityState& state, std::uint32_t body) {
  return state.names && body < state.names->size() ? std::string_view((*state.names)[body]) : std::string_view();
}

// What both kinds of pairs begin with.
template <class Pair>
JsonWriter& begin_pair(JsonWriter& out, const ProximityState& found, const Pair& pair) {
  const auto in_short = [&](std::uint32_t body) {
    return found.names && body < found.names->size() ? std::string_view(found.short_name(body)) : std::string_view();
  };
  return out.begin_object()
      .member("a", body_name(found, pair.a))
      .member("b", body_name(found, pair.b))
      .member("a_short", in_short(pair.a))
      .member("b_short", in_short(pair.b));
}

void add_touching(JsonWriter& out, const ProximityState& found) {
  out.begin_array();
  for (std::size_t i = 0; i < std::min(kMostPairs, found.touching.size()); ++i) {
    const TouchingPair& pair = found.touching[i];
    begin_pair(out, found, pair).member("depth_m", pair.depth_m).end_object();
  }
  out.end_array();
}

// Nearest first, without those that touch, which have a distance of 0 and are listed before.
std::span<const NearPair> apart(const ProximityState& found) {
  const auto first = std::ranges::find_if(found.near, [](const NearPair& pair) { return pair.distance_m > 0.0; });
  return {first, found.near.end()};
}

void add_near(JsonWriter& out, const ProximityState& found, std::span<const NearPair> near) {
  out.begin_array();
  for (const NearPair& pair : near.first(std::min(kMostPairs, near.size()))) {
    begin_pair(out, found, pair)
        .member("distance_m", pair.distance_m)
        .member("within_warning", pair.within_warning)
        .member("time_to_contact_s", pair.time_to_contact_s)
        .end_object();
  }
  out.end_array();
}

// Where nothing is tested, nobody knows what touches: an empty list would say that nothing does.
void add_proximity(JsonWriter& out, const LiveSources& sources) {
  const ProximityState* state = sources.proximity.get();
  const bool known = state != nullptr && state->pairs > 0 && sources.cell_state.collision->active;
  const ProximityState nothing;
  const ProximityState& found = known ? *state : nothing;
  out.key("touching");
  if (known) {
    add_touching(out, found);
  } else {
    out.null();
  }
  out.member("touching_count", found.touching.size()).key("near");
  const std::span<const NearPair> near = apart(found);
  add_near(out, found, near);
  out.member("near_count", near.size())
      .member("within_warning_count", std::ranges::count_if(near, &NearPair::within_warning))
      .member("warning_distance_m", sources.cell_state.collision->warning_distance_m)
      .member("collision_age_s", known ? age_s(sources.now, found.posture_time) : std::nullopt);
}

void add_ranges(JsonWriter& out, const RangeReadings* readings) {
  out.key("ranges").begin_array();
  if (readings != nullptr) {
    for (const RangeReading& reading : readings->readings) {
      out.begin_object()
          .member("id", reading.id)
          .member("path", reading.path)
          .member("distance_m", reading.distance_m)
          .member("range_m", reading.range_m)
          .member("object", reading.object)
          .member("object_short", reading.short_object.empty() ? reading.object : reading.short_object)
          .member("in_blind_zone", reading.in_blind_zone)
          .member("doubtful", reading.doubtful)
          .end_object();
    }
  }
  out.end_array();
}

void add_barriers(JsonWriter& out, const RangeReadings* readings) {
  out.key("light_barriers").begin_array();
  for (std::size_t i = 0; readings != nullptr && i < readings->barriers.size(); ++i) {
    const BarrierReading& barrier = readings->barriers[i];
    out.begin_object()
        .member("name", barrier.name)
        .member("interrupted", barrier.interrupted)
        .member("interruptions", barrier.interruptions)
        .member("object", barrier.object)
        .member("object_short", barrier.short_object.empty() ? barrier.object : barrier.short_object)
        .member("doubtful", barrier.doubtful)
        .end_object();
  }
  out.end_array();
}

void add_forces(JsonWriter& out, const ForceState* state) {
  out.key("forces").begin_array();
  for (std::size_t i = 0; state != nullptr && i < state->robots.size(); ++i) {
    const RobotForces& robot = state->robots[i];
    out.begin_object().member("robot", robot.id).key("tcp_force_n");
    if (robot.tcp_known) {
      out.value(robot.tcp_T.force);
    } else {
      out.null();
    }
    out.key("joints").begin_array();
    for (const JointForce& joint : robot.joints) {
      out.begin_object()
          .member("name", joint.name)
          .member("unit", joint.kind == JointKind::prismatic ? "N" : "Nm")
          .member("effort", joint.effort)
          .member("max_effort", joint.max_effort > 0.0 ? std::optional(joint.max_effort) : std::nullopt)
          .member("beyond_limit", joint.beyond_limit)
          .end_object();
    }
    out.end_array().end_object();
  }
  out.end_array();
}

void add_problems(JsonWriter& out, std::span<const Problem> problems) {
  out.key("problems").begin_array();
  for (const Problem& problem : problems)
    out.begin_object().member("kind", problem.kind).member("text", problem.text).end_object();
  out.end_array();
}

void add_alarms(JsonWriter& out, const AlarmCounts& alarms) {
  out.key("alarms")
      .begin_object()
      .member("revision", alarms.revision)
      .member("unacknowledged", alarms.unacknowledged())
      .member("active", alarms.active())
      .key("highest_priority");
  if (alarms.highest) {
    out.value(word(*alarms.highest));
  } else {
    out.null();
  }
  out.end_object();
}

void add_queues(JsonWriter& out, std::span<const engine::QueueStatus> queues) {
  out.key("queues").begin_array();
  for (const engine::QueueStatus& queue : queues) {
    out.begin_object()
        .member("name", queue.name)
        .member("dropped", queue.dropped)
        .member("high_water", queue.high_water)
        .member("capacity", queue.capacity)
        .end_object();
  }
  out.end_array();
}

void add_programs(JsonWriter& out, const ProgramsSnapshot& programs) {
  out.key("programs").begin_array();
  const std::size_t count = std::min(programs.programs.size(), kMostPrograms);
  for (std::size_t i = 0; i < count; ++i) {
    const program::ProgramStatus& status = programs.programs[i];
    out.begin_object()
        .member("robot", status.robot)
        .member("program", status.name)
        .member("state", program::name_of(status.state))
        .member("waits_for", status.waits_for)
        .member("step", status.step)
        .member("direction", status.direction == program::Direction::backward ? "backward" : "forward")
        .member("elapsed_s", status.elapsed_s)
        .member("expected_s", status.expected_s)
        .member("runs", status.runs)
        .member("error", status.error)
        .end_object();
  }
  out.end_array().member("deadlock", programs.deadlock ? programs.deadlock->text() : std::string());
}

void add_messages(JsonWriter& out, const DisplayState& display, Timestamp now) {
  out.key("messages").begin_array();
  for (const ShownText& message : display.messages) {
    out.begin_object()
        .member("number", message.number)
        .member("text", message.text)
        .member("bell", message.bell)
        .member("age_s", age_s(now, message.time))
        .end_object();
  }
  out.end_array().member("bell", display.on(DisplayMode::bell));
}

void add_views(JsonWriter& out, const LiveSources& sources) {
  const DisplayState& display = *sources.cell_state.display;
  const scene::PaneInput input{*sources.cell_state.cell, sources.poses, display, sources.now, sources.picture_updates};
  out.key("views").begin_array();
  for (std::size_t id = 0; id < kViews; ++id) {
    const DisplayView& view = display.views.at(id);
    const View now = scene::view_now(input, static_cast<int>(id));
    const bool moving = view.sequence && !scene::ended(*view.sequence, sources.now, sources.picture_updates);
    out.begin_object()
        .member("id", id)
        .member("name", display.layout.views.at(id).name)
        .member("viewpoint_m", now.viewpoint)
        .member("lookpoint_m", now.lookpoint)
        .member("twist_rad", now.twist)
        .member("opening_angle_rad", now.opening_angle)
        .member("camera", view.camera)
        .member("moving", moving)
        .end_object();
  }
  out.end_array();
}

// The main view first.
void add_displays(JsonWriter& out, const DisplayLayout& layout) {
  out.key("displays").begin_array();
  for (std::size_t i = 0; i < kDisplays; ++i) {
    out.begin_object().member("id", i + 1).member("name", layout.displays.at(i).name).key("views").begin_array();
    for (const LayoutPane& pane : layout.displays.at(i).panes) out.value(pane.view);
    out.end_array().end_object();
  }
  out.end_array();
}

void add_display(JsonWriter& out, const LiveSources& sources) {
  const DisplayState& display = *sources.cell_state.display;
  out.key("display").begin_object().member("display", display.display).member("full_screen", display.full_screen);
  add_views(out, sources);
  add_displays(out, display.layout);
  out.key("modes").begin_object();
  for (std::size_t i = 0; i < kDisplayModes; ++i) out.member(kDisplayModeWords.at(i), display.modes.test(i));
  out.member("LEGEND", display.legend).end_object().end_object();
  out.key("cameras").begin_array();
  for (const CameraSetting& camera : display.cameras) out.value(camera.name);
  out.end_array();
}

// The smallest bucket that at most a hundredth of what was recorded between `before` and `after` lies above.
double recent_p99_us(const HistogramSnapshot& before, const HistogramSnapshot& after) {
  const std::uint64_t all = after.count() - std::min(after.count(), before.count());
  if (all == 0) return 0.0;
  std::size_t low = 0;
  std::size_t high = LatencyBuckets::kCount - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const Nanoseconds limit = LatencyBuckets::upper_bound(middle);
    const std::uint64_t above =
        after.count_above(limit) - std::min(after.count_above(limit), before.count_above(limit));
    if (above * 100 <= all) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return microseconds(LatencyBuckets::upper_bound(low));
}

}  // namespace

LoopWindow::Figures LoopWindow::look(const CyclicThread& loop) {
  const HistogramSnapshot latency = loop.wakeup_latency().snapshot();
  const HistogramSnapshot compute = loop.compute_time().snapshot();
  const Figures figures{recent_p99_us(latency_, latency), recent_p99_us(compute_, compute)};
  latency_ = latency;
  compute_ = compute;
  return figures;
}

std::uint64_t TreeRevision::of(const std::shared_ptr<const CompiledCell>& cell) {
  const std::scoped_lock lock(mutex_);
  const bool same = last_ && (last_ == cell || (last_->paths == cell->paths && last_->visible == cell->visible));
  last_ = cell;
  if (!same) ++revision_;
  return revision_;
}

std::string live_document(const LiveSources& sources, LoopWindow& window, std::uint64_t tree_revision) {
  const std::int64_t time_ms = to_wall_clock_ns(sources.now) / 1'000'000;
  JsonWriter out;
  out.begin_object()
      .key("time_s")
      .fixed(1e-3 * static_cast<double>(time_ms), 3)
      .member("uptime_s", sources.uptime_s)
      .member("cell", sources.cell)
      .member("instance", sources.instance)
      .member("revision", sources.cell_state.cell->revision)
      .member("tree_revision", tree_revision);
  add_loop(out, sources, window.look(sources.loop));
  add_robots(out, sources);
  add_proximity(out, sources);
  add_ranges(out, sources.ranges.get());
  add_barriers(out, sources.ranges.get());
  add_forces(out, sources.forces.get());
  add_tissue(out, sources.tissue.get(), sources.cell_state, sources.now);
  add_volumes(out, sources.cell_state);
  add_programs(out, sources.cell_state.programs);
  add_queues(out, sources.queues);
  add_problems(out, sources.problems);
  add_alarms(out, sources.alarms);
  out.member("commands_logged", sources.commands_logged);
  add_messages(out, *sources.cell_state.display, sources.now);
  add_display(out, sources);
  if (sources.playback) add_playback(out.key("replay"), *sources.playback);
  return out.end_object().take();
}

}  // namespace cellmirror::app
