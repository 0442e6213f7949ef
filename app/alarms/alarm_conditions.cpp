#include "app/alarms/alarm_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "app/report/implausible_values.hpp"
#include "app/snapshot/haptic_names.hpp"
#include "app/snapshot/tissue_names.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::app {

namespace {

using namespace std::chrono_literals;

// Bodies that swing about a limit, and streams that falter, are one alarm and not many.
constexpr Nanoseconds kTouchingDelay = 1s;
constexpr Nanoseconds kNearDelay = 10s;
constexpr Nanoseconds kStreamDelay = 1s;
constexpr Nanoseconds kStaleOnDelay = 500ms;  // before the alarm is raised
constexpr Nanoseconds kBleedingDelay = 1s;

AlarmCondition touching(const std::string& a, const std::string& b) {
  return {.kind = "collision",
          .subject = a + " \u2013 " + b,
          .text = fmt::format("{} and {} touch", a, b),
          .priority = AlarmPriority::high,
          .off_delay = kTouchingDelay};
}

AlarmCondition near(const std::string& a, const std::string& b, double warning_distance_m) {
  return {.kind = "near",
          .subject = a + " \u2013 " + b,
          .text = fmt::format("{} and {} are nearer than {:.0f} mm", a, b, 1000 * warning_distance_m),
          .priority = AlarmPriority::low,
          .off_delay = kNearDelay};
}

void add_pairs(const LiveSources& sources, std::vector<AlarmCondition>& out) {
  const ProximityState* found = sources.proximity.get();
  if (found == nullptr || !found->names || found->pairs == 0 || !sources.cell_state.collision->active) return;
  const std::size_t bodies = found->names->size();
  std::set<std::pair<std::uint32_t, std::uint32_t>> in_contact;
  for (const TouchingPair& pair : found->touching) {
    if (std::max(pair.a, pair.b) >= bodies) continue;
    in_contact.emplace(pair.a, pair.b);
    out.push_back(touching(found->short_name(pair.a), found->short_name(pair.b)));
  }
  for (const NearPair& pair : found->near) {
    if (!pair.within_warning || std::max(pair.a, pair.b) >= bodies || in_contact.contains({pair.a, pair.b})) continue;
    out.push_back(near(found->short_name(pair.a), found->short_name(pair.b), found->warning_distance_m));
  }
}

const std::string& short_or(const std::string& in_short, const std::string& path) {
  return in_short.empty() ? path : in_short;
}

void add_events(std::span<const ProximityEvent> events, double warning_distance_m, std::vector<AlarmCondition>& out) {
  for (const ProximityEvent& event : events) {
    const std::string& a = short_or(event.short_a, event.a);
    const std::string& b = short_or(event.short_b, event.b);
    if (event.change == ProximityChange::touched) out.push_back(touching(a, b));
    if (event.change == ProximityChange::entered_warning) out.push_back(near(a, b, warning_distance_m));
  }
}

void add_haptics(const LiveSources& sources, std::vector<AlarmCondition>& out) {
  for (const HapticSnapshot& haptic : sources.cell_state.haptics) {
    if (!haptic.online) continue;
    const std::string fault = fault_text(sources.tick.haptics.at(haptic.channel), haptic.robot);
    if (fault.empty()) continue;
    out.push_back({.kind = "haptic",
                   .subject = haptic.robot,
                   .text = fmt::format("{}: {}", haptic.robot, fault),
                   .priority = AlarmPriority::high,
                   .off_delay = {}});
  }
}

void add_bleeding(const TissueState& tissue, std::vector<AlarmCondition>& out) {
  const auto add = [&](std::string subject, double ml_min) {
    std::string text = fmt::format("{} bleeds, {:.1f} ml/min", subject, ml_min);
    out.push_back({.kind = "bleeding",
                   .subject = std::move(subject),
                   .text = std::move(text),
                   .priority = AlarmPriority::high,
                   .off_delay = kBleedingDelay});
  };
  const std::size_t before = out.size();
  for (const TissueVesselState& vessel : tissue.vessels) {
    if (vessel.bleeding_ml_min > 0.0) add(fmt::format("{} of {}", vessel.name, vessel.object), vessel.bleeding_ml_min);
  }
  if (out.size() == before && tissue.bleeding_ml_min > 0.0) add("the tissue", tissue.bleeding_ml_min);
}

}  // namespace

// Data that are late now and then are stale for moments: that is not worth an alarm.
void AlarmConditions::add_streams(const LiveSources& sources, std::vector<AlarmCondition>& out) {
  for (std::size_t i = 0; i < sources.robots.size() && i < sources.cell_state.robots.size(); ++i) {
    const RobotSnapshot& robot = sources.cell_state.robots[i];
    const RobotState& state = sources.robots[i];
    const bool stale = state.online && state.state == DataState::stale;
    if (!stale) stale_since_.erase(robot.id);
    if (!state.online || state.state == DataState::fresh || state.state == DataState::none) continue;
    if (stale && sources.now - stale_since_.try_emplace(robot.id, sources.now).first->second < kStaleOnDelay) continue;
    std::string text =
        fmt::format("the data of {} are {}", robot.id,
                    state.state == DataState::conflict ? std::string_view("in conflict") : word(state.state));
    const std::string why = condition_text(sources.tick.robots.at(robot.slot), state,
                                           robot.stream ? robot.stream->status().condition : std::string());
    if (!stale && !why.empty()) text += ": " + why;
    out.push_back({.kind = "stream",
                   .subject = robot.id,
                   .text = std::move(text),
                   .priority = stale ? AlarmPriority::medium : AlarmPriority::high,
                   .off_delay = kStreamDelay});
  }
}

// Tears and excesses happen and are over; they stay until they are acknowledged.
void AlarmConditions::add_tissue_events(const LiveSources& sources, std::vector<AlarmCondition>& out) {
  const TissueState& tissue = sources.tissue->state;
  const std::uint64_t before = newest_tissue_event_;
  for (const TissueEvent& event : tissue.events) {
    if (event.number <= before) continue;
    newest_tissue_event_ = event.number;
    if (event.kind != TissueEventKind::tear && event.kind != TissueEventKind::limit) continue;
    const std::string object = object_name(tissue, event.object);
    const std::string_view part = part_of(event);
    std::string subject = part.empty() ? object : fmt::format("{} of {}", part, object);
    if (subject.empty()) subject = "tissue";
    std::string text = event.kind == TissueEventKind::tear ? fmt::format("{} tears", subject)
                                                           : fmt::format("{} is beyond {}", subject, word(event.limit));
    out.push_back({.kind = event.kind == TissueEventKind::tear ? "tear" : "limit",
                   .subject = std::move(subject),
                   .text = std::move(text),
                   .priority = AlarmPriority::medium,
                   .off_delay = {}});
  }
}

std::vector<AlarmCondition> AlarmConditions::look(const LiveSources& sources, const FaultStatus& faults,
                                                  std::span<const ProximityEvent> events) {
  std::vector<AlarmCondition> out;
  if (faults.latched)
    out.push_back(
        {.kind = "loop", .subject = "loop", .text = faults.reason, .priority = AlarmPriority::high, .off_delay = {}});
  add_streams(sources, out);
  add_haptics(sources, out);
  if (sources.tissue) {
    add_bleeding(sources.tissue->state, out);
    add_tissue_events(sources, out);
  }
  for (const Problem& problem : sources.problems)
    out.push_back({.kind = "problem",
                   .subject = problem.kind,
                   .text = problem.text,
                   .priority = AlarmPriority::medium,
                   .off_delay = {}});
  // Last: where there are too many, the others have their places.
  add_pairs(sources, out);
  add_events(events, sources.cell_state.collision->warning_distance_m, out);
  if (!events.empty()) newest_event_ = events.back().sequence;
  return out;
}

}  // namespace cellmirror::app
