#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "app/console/display_names.hpp"
#include "app/simulation/simulation_report.hpp"
#include "app/simulation/tissue_summary.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kListedMoves = 20;       // the longest
constexpr std::size_t kListedCollisions = 30;  // the first
constexpr std::size_t kListedRefusals = 30;
constexpr std::size_t kListedLimits = 40;
constexpr std::size_t kListedMessages = 30;
constexpr std::size_t kLongestText = 400;

struct Unit {
  double factor;
  const char* position;
  const char* velocity;
  const char* acceleration;
};

Unit unit_of(JointKind kind) {
  if (kind == JointKind::prismatic) return {1e3, "mm", "mm/s", "mm/s2"};
  return {180.0 / std::numbers::pi, "deg", "deg/s", "deg/s2"};
}

std::string more(std::size_t count) { return count == 0 ? "" : fmt::format("  ... and {} more (--json)\n", count); }

std::string heading(const SimulationResult& result) {
  std::string text = fmt::format("{}: {}: {:.3f} s simulated in {:.3f} s, {:.0f} times real time; tick {:g} ms\n",
                                 printable(result.cell), printable(result.script), result.simulated_s, result.wall_s,
                                 result.times_real_time(), 1e3 * result.tick_s);
  if (result.end != SimulationEnd::finished)
    text += fmt::format("NOT FINISHED: {}{}{}\n", end_word(result.end), result.end_note.empty() ? "" : ": ",
                        printable(result.end_note, kLongestText));
  for (const std::string& deadlock : result.deadlocks)
    text += fmt::format("DEADLOCK: {}\n", printable(deadlock, kLongestText));
  return text;
}

std::string programs(const SimulationResult& result) {
  if (result.programs.empty()) return {};
  std::string text = "\nprograms\n";
  for (const SimulatedProgram& run : result.programs) {
    text += fmt::format("  {:9.3f} .. {:9.3f} s  {:9.3f} s  {} {}: {}, {}", run.begin_s, run.end_s,
                        run.end_s - run.begin_s, run.robot, run.name, run.end, number_of(run.moves, "move"));
    if (!run.waits_for.empty()) text += ", waits for " + printable(run.waits_for, kLongestText);
    if (!run.error.empty()) text += ": " + printable(run.error, kLongestText);
    text += '\n';
  }
  return text;
}

std::string messages(const SimulationResult& result) {
  if (result.messages.empty()) return {};
  std::string text = "\nmessages\n";
  const std::size_t shown = std::min(result.messages.size(), kListedMessages);
  for (std::size_t i = 0; i < shown; ++i)
    text +=
        fmt::format("  {:9.3f} s  {}\n", result.messages[i].time_s, printable(result.messages[i].text, kLongestText));
  return text + more(result.messages.size() - shown + result.more_messages);
}

std::string robots(const SimulationResult& result) {
  std::string text;
  for (const RobotFindings& robot : result.robots) {
    if (robot.moves == 0 && !robot.moved) continue;
    text += fmt::format("  {}: {}, under way for {:.3f} s\n", robot.id, number_of(robot.moves, "move"), robot.moving_s);
  }
  return text.empty() ? text : "\nrobots that moved\n" + text;
}

std::string moves(const SimulationResult& result) {
  if (result.moves.empty()) return {};
  std::vector<const SimulatedMove*> longest;
  for (const SimulatedMove& move : result.moves) longest.push_back(&move);
  std::ranges::stable_sort(longest,
                           [](const auto* a, const auto* b) { return a->end_s - a->begin_s > b->end_s - b->begin_s; });
  const std::size_t shown = std::min(longest.size(), kListedMoves);
  std::ranges::sort(longest.begin(), longest.begin() + static_cast<long>(shown), {},
                    [](const SimulatedMove* move) { return std::pair(move->begin_s, move->end_s); });
  std::string text = fmt::format(
      "\nmoves{}\n", shown < longest.size() ? fmt::format(", the longest {} of {}", shown, longest.size()) : "");
  for (std::size_t i = 0; i < shown; ++i) {
    const SimulatedMove& move = *longest[i];
    text += fmt::format("  {:9.3f} .. {:9.3f} s  {:9.3f} s  {} {}", move.begin_s, move.end_s, move.end_s - move.begin_s,
                        move.robot, move.kind);
    if (!move.program.empty()) text += fmt::format("  {}:{}", printable(move.program), move.line);
    if (move.outcome != "arrived") text += "  " + move.outcome;
    text += '\n';
  }
  return text;
}

void add_limits(const RobotFindings& robot, std::vector<std::string>& violated, std::vector<std::string>& approached) {
  for (const JointFindings& joint : robot.joints) {
    const Unit unit = unit_of(joint.kind);
    if (joint.range_violated() || joint.range_approached()) {
      (joint.range_violated() ? violated : approached)
          .push_back(fmt::format("{} {}: at {:.2f} {}, limit {:.2f} {}, at {:.3f} s", robot.id, joint.name,
                                 unit.factor * joint.position->value, unit.position,
                                 unit.factor * joint.position->limit, unit.position, joint.position->time_s));
    }
    if (joint.velocity_violated() || joint.velocity_approached()) {
      (joint.velocity_violated() ? violated : approached)
          .push_back(fmt::format("{} {}: {:.1f} % of its speed, {:.2f} of {:.2f} {}, at {:.3f} s", robot.id, joint.name,
                                 100.0 * joint.velocity_share, unit.factor * std::abs(joint.velocity.value),
                                 unit.factor * joint.velocity.limit, unit.velocity, joint.velocity.time_s));
    }
  }
}

std::string limit_list(const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string text = fmt::format("\n{}\n", title);
  const std::size_t shown = std::min(lines.size(), kListedLimits);
  for (std::size_t i = 0; i < shown; ++i) text += fmt::format("  {}\n", lines[i]);
  return text + more(lines.size() - shown);
}

std::string limits(const SimulationResult& result) {
  std::vector<std::string> violated;
  std::vector<std::string> approached;
  for (const RobotFindings& robot : result.robots) add_limits(robot, violated, approached);
  return limit_list("limits violated", violated) + limit_list("limits approached", approached);
}

std::string collisions(const SimulationResult& result) {
  const CollisionSummary& found = result.collision;
  if (!found.tested) return fmt::format("\ncollisions were not tested: {}\n", found.why_not);
  std::string text =
      fmt::format("\ncollisions: {}, tested every {:g} ms of simulated time while anything moved: {}, {} touch\n",
                  number_of(found.pairs, "pair"), 1e3 * found.period_s, number_of(found.tests, "test"),
                  found.collisions.size() + found.more_collisions);
  std::vector<std::string> paths;
  for (const SimulatedCollision& c : found.collisions) {
    paths.push_back(c.a);
    paths.push_back(c.b);
  }
  if (found.smallest_distance_m) paths.insert(paths.end(), {found.nearest_a, found.nearest_b});
  const std::vector<std::string> names = short_names(paths);
  const std::size_t shown = std::min(found.collisions.size(), kListedCollisions);
  for (std::size_t i = 0; i < shown; ++i) {
    const SimulatedCollision& c = found.collisions[i];
    const std::string end = c.end_s ? fmt::format("{:9.3f} s", *c.end_s) : "      end  ";
    text += fmt::format("  {:9.3f} .. {}  {} - {}: at most {:.4f} m deep{}\n", c.begin_s, end, names[2 * i],
                        names[2 * i + 1], c.depth_m, c.doubtful ? ", in doubt" : "");
  }
  text += more(found.collisions.size() - shown + found.more_collisions);
  if (found.smallest_distance_m)
    text += fmt::format("  smallest distance {:.4f} m at {:.3f} s: {} - {}\n", *found.smallest_distance_m,
                        found.smallest_distance_s, names[names.size() - 2], names.back());
  return text;
}

std::string refusals(const SimulationResult& result) {
  if (result.refusals.empty()) return {};
  std::string text = "\nrefused commands\n";
  const std::size_t shown = std::min(result.refusals.size(), kListedRefusals);
  for (std::size_t i = 0; i < shown; ++i) {
    const Refusal& refusal = result.refusals[i];
    text += fmt::format("  {:9.3f} s  {}\n", refusal.time_s, printable(refusal.diagnostic.text(), kLongestText));
  }
  return text + more(result.refusals.size() - shown + result.more_refusals);
}

}  // namespace

const char* end_word(SimulationEnd end) {
  switch (end) {
    case SimulationEnd::finished:
      return "finished";
    case SimulationEnd::time_limit:
      return "time limit";
    case SimulationEnd::stands_still:
      return "stands still";
  }
  return "unknown";
}

std::string simulation_text(const SimulationResult& result) {
  return heading(result) + programs(result) + messages(result) + robots(result) + moves(result) + limits(result) +
         collisions(result) + tissue_text(result) + refusals(result);
}

}  // namespace cellmirror::app
