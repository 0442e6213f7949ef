#include <fmt/format.h>

#include <algorithm>

#include "config/node_reader.hpp"
#include "config/parse.hpp"
#include "config/robot_builder.hpp"
#include "config/volume_table.hpp"
#include "rt_core/base/capacity.hpp"

namespace cellmirror {

namespace {

int read_node_name(TableReader& reader, const NodeReader& nodes, std::string_view key, int fallback) {
  const auto name = reader.text(key);
  return name ? nodes.find(reader, key, *name) : fallback;
}

Pose read_offset(TableReader& reader, std::string_view key) {
  auto table = reader.table(key);
  if (!table) return Pose::Identity();
  const Pose X = table->pose();
  table->finish();
  return X;
}

void read_robot(TableReader& reader, const NodeReader& nodes, Component& component) {
  RobotDefinition robot;
  reader.require("id");
  robot.id = reader.name("id").value_or("robot");
  const Place place = reader.place();
  robot.line = place.line;
  robot.column = place.column;
  robot.base = read_node_name(reader, nodes, "base", -1);
  robot.zero_point = read_node_name(reader, nodes, "zero_point", robot.base);
  reader.require("flange");
  robot.flange = read_node_name(reader, nodes, "flange", -1);
  RobotParameters& p = robot.parameters;
  p.linear_velocity = reader.number("linear_velocity_m_s", kPositive).value_or(p.linear_velocity);
  p.linear_acceleration = reader.number("linear_acceleration_m_s2", kPositive).value_or(p.linear_acceleration);
  p.rotational_velocity = reader.number("rotational_velocity_rad_s", kPositive).value_or(p.rotational_velocity);
  p.rotational_acceleration =
      reader.number("rotational_acceleration_rad_s2", kPositive).value_or(p.rotational_acceleration);
  p.X_FP = read_offset(reader, "point_of_reference");
  p.X_PT = read_offset(reader, "tool_center_point");
  reader.finish();
  component.robot = robot;
  complete_robot(component, place, reader.diagnostics());
}

}  // namespace

std::optional<Component> parse_component(std::string_view text, const std::string& file, const FileFinder& files,
                                         Diagnostics& diagnostics) {
  const auto table = parse_toml(text, file, diagnostics);
  if (!table) return std::nullopt;
  Diagnostics findings;
  TableReader reader(*table, file, "", findings);
  Component component;
  component.file = file;
  reader.format();
  component.description = reader.text("description").value_or("");
  component.geometry = read_geometry(reader, files);
  component.inertia = read_body(reader);
  Diagnostics of_volume;
  component.volume = read_volume_table(reader, files, of_volume);
  NodeReader nodes(component, files, false);
  for (TableReader& node : reader.tables("node", kMaxNodes)) nodes.read(node);
  nodes.finish(findings);
  auto robot = reader.table("robot");
  if (robot) {
    read_robot(*robot, nodes, component);
  } else if (!reader.has("robot")) {
    const auto joint =
        std::ranges::find_if(component.nodes, [](const ComponentNode& node) { return node.joint.has_value(); });
    if (joint != component.nodes.end())
      findings.error(component.place(*joint), fmt::format("the joint {} does not belong to a robot", joint->name),
                     "add [robot] with an id, so that the joint can be moved");
  }
  reader.finish();
  take_sorted(diagnostics, findings);
  diagnostics.take(of_volume);
  return component;
}

void take_sorted(Diagnostics& to, const Diagnostics& from) {
  std::vector<Diagnostic> kept = from.all();
  std::ranges::stable_sort(kept, {}, [](const Diagnostic& d) { return std::pair(d.place.line, d.place.column); });
  for (const Diagnostic& diagnostic : kept) to.add(diagnostic);
  const std::size_t found = from.errors() + from.warnings();
  if (found > kept.size())
    to.error({kept.front().place.file, 0, 0}, fmt::format("and {} more diagnostics in this file", found - kept.size()));
}

}  // namespace cellmirror
