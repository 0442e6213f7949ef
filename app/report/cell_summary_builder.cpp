#include "app/report/cell_summary_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>
#include <string_view>
#include <utility>

#include "rt_core/base/counted.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::app {

namespace {

RobotSummary robot_of(const LiveSources& sources, std::size_t i) {
  const RobotSnapshot& robot = sources.cell_state.robots[i];
  const RobotState& state = sources.robots[i];
  RobotSummary out{.id = robot.id, .mirrored = state.online};
  if (!state.online) return out;
  out.state = state.state;
  const Timestamp received = sources.tick.robots.at(robot.slot).receive_time;
  if (received.known()) out.age_s = seconds(sources.now - received);
  return out;
}

void add_robots(const LiveSources& sources, CellSummary& out) {
  const std::size_t robots = std::min(sources.robots.size(), sources.cell_state.robots.size());
  for (std::size_t i = 0; i < std::min(robots, kMostSummaryRobots); ++i) out.robots.push_back(robot_of(sources, i));
  out.robots_left_out = robots - out.robots.size();
}

void add_findings(const ProximityState& found, CellSummary& out) {
  const auto pair_of = [&](std::uint32_t a, std::uint32_t b) {
    return BodyPair{found.short_name(a), found.short_name(b)};
  };
  out.touching = found.touching.size();
  for (const TouchingPair& pair : found.touching | std::views::take(kMostSummaryPairs))
    out.touching_pairs.push_back(pair_of(pair.a, pair.b));
  if (const NearPair* nearest = found.nearest()) {
    out.nearest = NearestPair{pair_of(nearest->a, nearest->b), nearest->distance_m};
  } else if (!out.touching_pairs.empty()) {
    out.nearest = NearestPair{out.touching_pairs.front(), 0};
  }
}

// Collects why a cell is not well, worst first, with the health that follows.
class HealthFinder {
 public:
  explicit HealthFinder(CellSummary& summary) : summary_(summary) {}

  void add(CellHealth health, std::string reason) {
    summary_.health = std::max(summary_.health, health);
    if (summary_.reasons.size() < kMostSummaryReasons) summary_.reasons.push_back(std::move(reason));
  }

 private:
  CellSummary& summary_;
};

void add_health(const LiveSources& sources, const web::Health& loop, CellSummary& out) {
  HealthFinder health(out);
  if (!loop.ok) health.add(CellHealth::fault, loop.text);
  // A broker that is away is no fault of the cell.
  for (const Problem& problem : sources.problems)
    health.add(problem.kind == "mqtt" ? CellHealth::attention : CellHealth::fault, problem.text);
  if (out.touching > 0) health.add(CellHealth::attention, number_of(out.touching, "pair") + " of bodies in contact");
  for (const RobotSummary& robot : out.robots) {
    if (robot.mirrored && robot.state != DataState::fresh)
      health.add(CellHealth::attention, fmt::format("{}: {}", robot.id, word(robot.state)));
  }
  if (out.alarms.unacknowledged > 0)
    health.add(CellHealth::attention, number_of(out.alarms.unacknowledged, "alarm") + " that nobody has acknowledged");
}

}  // namespace

CellSummary summary_of(const LiveSources& sources, const SummaryFacts& facts) {
  CellSummary out;
  out.cell = sources.cell;
  out.host = facts.host;
  out.instance = sources.instance;
  out.run = facts.run;
  out.time_ns = facts.time_ns;
  out.uptime_s = sources.uptime_s;
  out.replay = sources.playback.has_value();
  out.loop = {sources.rate_hz, sources.loop.missed(), facts.faults, facts.loop.ok};
  add_robots(sources, out);
  if (sources.proximity) add_findings(*sources.proximity, out);
  out.alarms = {sources.alarms.active(), sources.alarms.unacknowledged()};
  out.page_port = facts.page_port;
  add_health(sources, facts.loop, out);
  return out;
}

}  // namespace cellmirror::app
