#include "app/new_cell/simulation_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/new_cell/names.hpp"
#include "rt_core/base/shell_word.hpp"

namespace cellmirror::app {

namespace {

// How far a joint goes from its start: a part of the room that it has there.
double reach_of(const PlannedJoint& joint) {
  constexpr double kFurthestTurn = 0.4;   // rad
  constexpr double kFurthestShift = 0.1;  // m
  constexpr double kPartOfRoom = 0.4;
  const double furthest = joint.kind == JointKind::prismatic ? kFurthestShift : kFurthestTurn;
  if (joint.kind == JointKind::continuous) return furthest;
  const double up = joint.max_position - joint.start_position;
  const double down = joint.start_position - joint.min_position;
  return up >= down ? std::min(furthest, kPartOfRoom * up) : -std::min(furthest, kPartOfRoom * down);
}

// Between two rows a position follows a minimum jerk curve, whose peak speed is 15/8 of its mean; a quarter of the
// joint's speed is enough.
double seconds_between_rows(const PlannedRobot& robot) {
  constexpr double kLeast = 2.0;
  constexpr double kMost = 60.0;
  double seconds = kLeast;
  for (const PlannedJoint& joint : robot.joints) {
    if (joint.max_velocity > 0) seconds = std::max(seconds, 7.5 * std::fabs(reach_of(joint)) / joint.max_velocity);
  }
  return std::min(std::ceil(seconds), kMost);
}

std::string row_text(const PlannedRobot& robot, double time_s, double part) {
  std::string row = number_text(time_s);
  for (const PlannedJoint& joint : robot.joints)
    row += fmt::format(", {:.4f}", joint.start_position + part * reach_of(joint));
  return row + "\n";
}

template <class Item, class Text>
std::string joined(const std::vector<Item>& items, Text text) {
  std::string out;
  for (const Item& item : items) out += (out.empty() ? "" : ",") + text(item);
  return out;
}

Simulation of_topic(const PlannedRobot& robot) {
  const bool comma = std::ranges::any_of(
      robot.joints, [](const PlannedJoint& joint) { return joint.name.find(',') != std::string::npos; });
  if (comma) return {{}, "the name of a joint has a comma"};
  return {{"sim_robot", "dds", "--topic", robot.topic, "--joint-names",
           joined(robot.joints, [](const PlannedJoint& joint) { return joint.name; })},
          {}};
}

Simulation of_drives(const CellPlan& plan, const PlannedRobot& robot) {
  const bool usual = std::ranges::all_of(robot.drives, &PlannedDrive::default_mapping);
  if (!usual) return {{}, "its EDS maps the position into another TPDO than simulated drives send"};
  return {{"sim_robot", "cia402", "--channel", plan.channel, "--nodes",
           joined(robot.drives, [](const PlannedDrive& drive) { return fmt::format("{}", drive.node); }),
           "--increments-per-rad",
           joined(robot.drives, [](const PlannedDrive& drive) { return number_text(drive.increments); })},
          {}};
}

Simulation of_signals(const CellPlan& plan, const PlannedRobot& robot) {
  std::vector<PlannedSignal> positions;
  std::ranges::copy_if(robot.signals, std::back_inserter(positions),
                       [](const PlannedSignal& signal) { return signal.quantity == JointQuantity::position; });
  const auto other_scale = [&](const PlannedSignal& signal) { return signal.scale != positions.front().scale; };
  if (std::ranges::any_of(positions, other_scale)) return {{}, "the scales of its signals differ"};
  return {{"sim_robot", "dbc", "--channel", plan.channel, "--dbc", "robots/" + robot.dbc, "--position",
           joined(positions, [](const PlannedSignal& signal) { return signal.message + "." + signal.signal; }),
           "--units-per-rad", number_text(1.0 / positions.front().scale)},
          {}};
}

// Of the shell, to be pasted.
std::string command_line(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + shell_word(word);
  return out;
}

std::string source_text(const CellPlan& plan, const PlannedRobot& robot) {
  if (!robot.topic.empty()) return fmt::format("ROS 2 topic `{}`", robot.topic);
  if (!robot.drives.empty())
    return fmt::format("{} CiA 402 drive{} on `{}`", robot.drives.size(), robot.drives.size() == 1 ? "" : "s",
                       plan.channel);
  return fmt::format("`{}` on `{}`", robot.dbc, plan.channel);
}

}  // namespace

std::string motion_text(const PlannedRobot& robot) {
  const double step = seconds_between_rows(robot);
  std::string out = "time_s";
  for (std::size_t i = 1; i <= robot.joints.size(); ++i) out += fmt::format(", q{}", i);
  return out + "\n" + row_text(robot, 0.0, 0.0) + row_text(robot, step, 1.0) + row_text(robot, 2.0 * step, 0.0);
}

std::string motion_file(const PlannedRobot& robot) { return "motion_" + plain_file_name(robot.node) + ".csv"; }

Simulation simulation_of(const CellPlan& plan, const PlannedRobot& robot) {
  Simulation simulation = !robot.topic.empty()    ? of_topic(robot)
                          : !robot.drives.empty() ? of_drives(plan, robot)
                                                  : of_signals(plan, robot);
  if (simulation.words.empty()) return simulation;
  for (const std::string& word :
       {std::string("--rate"), std::string("100"), std::string("--motion"), "waypoints:" + motion_file(robot)})
    simulation.words.push_back(word);
  return simulation;
}

std::string simulators_text(const CellPlan& plan) {
  std::string out =
      "# The robots of the cell, simulated: a name, a program and its arguments a line; to be run in this folder.\n";
  for (const PlannedRobot& robot : plan.robots) {
    const Simulation simulation = simulation_of(plan, robot);
    if (simulation.words.empty()) {
      out += fmt::format("# {}: {}\n", robot.node, simulation.why);
      continue;
    }
    out += fmt::format("{} {}\n", robot.node, fmt::join(simulation.words, " "));
  }
  return out;
}

std::string readme_text(const CellPlan& plan) {
  std::string out = fmt::format("# {}\n\nA cell made by `cellmirror new`.\n\n", plan.name);
  out += "| robot | joints | its values come from |\n| --- | --- | --- |\n";
  for (const PlannedRobot& robot : plan.robots)
    out += fmt::format("| `{}` | {} | {} |\n", robot.id, robot.joints.size(), source_text(plan, robot));
  out += "\n## What was guessed\n\n";
  for (const std::string& guess : plan.guesses) out += "- " + guess + "\n";
  out +=
      "\nEvery line with `DECIDE` is a guess that you have to confirm or to correct:\n\n"
      "```\ngrep -rn DECIDE .\ncellmirror check cell.toml\n```\n\n"
      "## Run it\n\n```\ncellmirror run cell.toml\ncellmirror status      # in a second terminal\n"
      "cellmirror page        # the address of the monitor page\n```\n\n"
      "## Without the robots\n\nIn this folder, each in a terminal of its own:\n\n```\n";
  for (const PlannedRobot& robot : plan.robots) {
    const Simulation simulation = simulation_of(plan, robot);
    out += simulation.words.empty() ? fmt::format("# {} cannot be simulated as it is: {}\n", robot.node, simulation.why)
                                    : command_line(simulation.words) + "\n";
  }
  return out + "```\n";
}

}  // namespace cellmirror::app
