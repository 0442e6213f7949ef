#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/simulation/simulation_report.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kMostBars = 20'000;
constexpr std::size_t kMostMarks = 12;
constexpr std::size_t kMostPanels = 24;

// One row a robot that moved or ran programs: its programs above, its moves below.
plot::Panel rows_panel(const SimulationResult& result, const plot::Axis& time) {
  plot::Panel panel;
  panel.title = "Programs (orange: failed) and their moves (light blue: delays)";
  panel.x = time;
  const auto row_of = [&panel](const std::string& name) {
    const auto known = std::ranges::find(panel.rows, name);
    if (known != panel.rows.end()) return static_cast<std::size_t>(known - panel.rows.begin());
    panel.rows.push_back(name);
    return panel.rows.size() - 1;
  };
  for (const SimulatedProgram& run : result.programs) {
    if (panel.bars.size() < kMostBars)
      panel.bars.push_back(
          {row_of(run.robot), run.begin_s, run.end_s, run.end == "failed" ? 1UL : 0UL, run.name, 0.0, 0.45});
  }
  for (const SimulatedMove& move : result.moves) {
    if (panel.bars.size() < kMostBars)
      panel.bars.push_back(
          {row_of(move.robot), move.begin_s, move.end_s, move.kind == "delay" ? 4UL : 2UL, "", 0.55, 0.9});
  }
  return panel;
}

plot::Panel joints_panel(const SimulationResult& result, const RobotFindings& robot, const plot::Axis& time) {
  plot::Panel panel;
  panel.title = printable(robot.id) + ": joints in their ranges";
  panel.x = time;
  panel.y = {"share of the range [%]", false, 0, 100};
  for (const JointFindings& joint : robot.joints) {
    plot::Line line{printable(joint.name), result.sample_times_s, joint.shares_of_range};
    for (double& share : line.y) share *= 100.0;
    panel.lines.push_back(std::move(line));
  }
  return panel;
}

plot::Panel distance_panel(const SimulationResult& result, const plot::Axis& time) {
  const CollisionSummary& found = result.collision;
  plot::Panel panel;
  panel.title = "Smallest distance of all tested pairs";
  panel.x = time;
  panel.y = {"distance [m]"};
  panel.lines = {{"smallest distance", found.distance_times_s, found.distances_m},
                 {"warning distance", {time.low, time.high}, {found.warning_distance_m, found.warning_distance_m}}};
  for (const SimulatedCollision& c : found.collisions) {
    if (panel.marks.size() == kMostMarks) break;
    panel.marks.push_back({c.begin_s, fmt::format("{:.2f} s: {} - {}", c.begin_s, c.a, c.b)});
  }
  return panel;
}

}  // namespace

plot::Figure simulation_figure(const SimulationResult& result) {
  plot::Figure out;
  out.title = fmt::format("{}: {}", printable(result.cell), printable(result.script));
  out.subtitle = fmt::format("{:.3f} s simulated, {}; {}, {}", result.simulated_s, end_word(result.end),
                             number_of(result.programs.size(), "program"), number_of(result.moves.size(), "move"));
  if (result.collision.tested)
    out.subtitle +=
        fmt::format("; {}, tested every {:g} ms",
                    number_of(result.collision.collisions.size() + result.collision.more_collisions, "collision"),
                    1e3 * result.collision.period_s);
  out.columns = 1;
  out.panel_width = 1400;
  out.panel_height = 400;
  const plot::Axis time{"time [s]", false, 0.0, std::max(result.simulated_s, 1e-3)};
  out.panels.push_back(rows_panel(result, time));
  for (const RobotFindings& robot : result.robots) {
    if (robot.moved && out.panels.size() < kMostPanels) out.panels.push_back(joints_panel(result, robot, time));
  }
  if (result.collision.tested) out.panels.push_back(distance_panel(result, time));
  return out;
}

}  // namespace cellmirror::app
