#include "config/node_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "rt_core/base/text.hpp"

namespace cellmirror {

std::string NodeReader::path(int node) const {
  std::string out;
  for (int at = node; at >= 0; at = component_.nodes[static_cast<std::size_t>(at)].parent) {
    const std::string& name = component_.nodes[static_cast<std::size_t>(at)].name;
    out = out.empty() ? name : name + "." + out;
  }
  return out;
}

int NodeReader::find(const TableReader& reader, std::string_view key, std::string_view wanted) const {
  const std::size_t dot = wanted.rfind('.');
  const std::string last(dot == std::string_view::npos ? wanted : wanted.substr(dot + 1));
  std::vector<int> found;
  if (const auto at = by_name_.find(last); at != by_name_.end()) {
    for (const int node : at->second) {
      const std::string full = path(node);
      if (full == wanted) return node;
      if (full.ends_with("." + std::string(wanted))) found.push_back(node);
    }
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    reader.error(key, fmt::format("{} \"{}\" is ambiguous", key, printable(wanted)),
                 fmt::format("name {} or {}", path(found[0]), path(found[1])));
    return -1;
  }
  std::vector<std::string> names;
  for (const auto& [name, nodes] : by_name_) names.push_back(name);
  std::ranges::sort(names);
  const std::string near = did_you_mean(last, names);
  reader.error(key, fmt::format("{} \"{}\" is not a node of this file above this one", key, printable(wanted)),
               near.empty() ? "a node must come after the nodes that it names" : near);
  return -1;
}

namespace {

SensorDefinition read_sensor(TableReader& table) {
  constexpr double kRightAngle = 0.5 * std::numbers::pi;
  SensorDefinition sensor;
  sensor.range_m = table.number("range_m", {0.0, 1e3, true}).value_or(sensor.range_m);
  sensor.half_angle_rad =
      table.number("half_angle_rad", {0.0, kRightAngle, true, true}).value_or(sensor.half_angle_rad);
  sensor.blind_zone_m = table.number("blind_zone_m", {0.0, 1e3}).value_or(sensor.blind_zone_m);
  if (sensor.blind_zone_m >= sensor.range_m)
    table.error("blind_zone_m", "the blind zone is not smaller than the range of the sensor");
  sensor.active = table.boolean("active").value_or(sensor.active);
  sensor.max_incidence_rad =
      table.number("max_incidence_rad", {0.0, kRightAngle, true}).value_or(sensor.max_incidence_rad);
  sensor.noise_m = table.number("noise_m", {0.0, 1.0}).value_or(sensor.noise_m);
  constexpr long long kLargestSeed = 0xFFFF'FFFF;
  const auto seed = table.integer("seed", 0, kLargestSeed);
  if (seed) sensor.seed = static_cast<std::uint64_t>(*seed);
  table.finish();
  return sensor;
}

}  // namespace

void NodeReader::read_kind(TableReader& reader, ComponentNode& node) const {
  const auto kind = reader.choice<NodeKind>("type", {{"frame", NodeKind::frame},
                                                     {"joint", NodeKind::joint},
                                                     {"workframe", NodeKind::workframe},
                                                     {"camera", NodeKind::camera},
                                                     {"sensor", NodeKind::sensor}});
  node.kind = kind.value_or(NodeKind::frame);
  if (auto table = reader.table("joint")) {
    node.joint = read_joint(*table);
    if (!reader.has("type")) node.kind = NodeKind::joint;
    if (kind && node.kind != NodeKind::joint)
      reader.error("joint", "joint = {...} belongs to a node of type \"joint\"");
  } else if (node.kind == NodeKind::joint) {
    if (!reader.has("joint")) reader.error({}, "a joint needs joint = { type = ..., axis = ..., ... }");
    node.kind = NodeKind::frame;
  }
  if (auto table = reader.table("camera")) {
    if (node.kind != NodeKind::camera) reader.error("camera", "camera = {...} belongs to a node of type \"camera\"");
    node.camera.focal_distance_m = table->number("focal_distance_m", kPositive).value_or(node.camera.focal_distance_m);
    node.camera.fovy_rad = table->number("fovy_rad", {0.0, 3.1, true}).value_or(node.camera.fovy_rad);
    table->finish();
  }
  if (auto table = reader.table("sensor")) {
    if (node.kind != NodeKind::sensor) reader.error("sensor", "sensor = {...} belongs to a node of type \"sensor\"");
    node.sensor = read_sensor(*table);
  }
}

void NodeReader::read_abstract(TableReader& reader, ComponentNode& node) const {
  const auto file = reader.text("abstract");
  const auto shown =
      reader.choice<Shown>("shown", {{"detail", Shown::detail}, {"coarse", Shown::coarse}, {"hidden", Shown::hidden}});
  const auto loaded = reader.boolean("loaded");
  const auto robot_id = reader.name("robot_id");
  const auto robot_base = reader.text("robot_base");
  const auto robot_flange = reader.text("robot_flange");
  const auto collide_as = read_collide_as(reader);
  node.shown = shown.value_or(Shown::detail);
  if (!reader.has("abstract")) {
    for (const char* key : {"loaded", "robot_id", "robot_base", "robot_flange", "collide_as"}) {
      if (reader.has(key)) reader.error(key, fmt::format("{} belongs to a node with an ABSTRACT file", key));
    }
    if (node.shown == Shown::coarse) reader.error("shown", "only a node with an ABSTRACT file can be shown coarsely");
    return;
  }
  if (node.kind == NodeKind::joint)
    reader.error("abstract", "a joint cannot have an ABSTRACT file", "give it to a frame below the joint");
  AbstractReference reference;
  reference.file = file.value_or("");
  reference.line = reader.place("abstract").line;
  reference.column = reader.place("abstract").column;
  reference.loaded = loaded.value_or(node.shown == Shown::detail);
  if (!reference.loaded && node.shown == Shown::detail) {
    reader.error("loaded", "a component that is not loaded cannot be shown in detail",
                 "give shown = \"coarse\" or \"hidden\"");
  }
  reference.robot_id = robot_id.value_or("");
  reference.collide_as = collide_as;
  reference.robot_base = robot_base.value_or("");
  reference.robot_flange = robot_flange.value_or("");
  node.abstract = reference;
}

void NodeReader::read(TableReader& reader) {
  ComponentNode node;
  reader.require("name");
  const auto name = reader.name("name");
  node.name = name.value_or("");
  if (name) reader.set_where("node " + *name);
  const Place place = reader.place();
  node.line = place.line;
  node.column = place.column;
  if (const auto parent = reader.text("parent")) node.parent = find(reader, "parent", *parent);
  if (is_cell_) node.predecessor = reader.text("predecessor").value_or("");
  node.X_PF = reader.pose();
  read_kind(reader, node);
  read_abstract(reader, node);
  node.geometry = read_geometry(reader, files_);
  node.inertia = read_body(reader);
  reader.finish();
  if (!name) return;
  auto& same_name = by_name_[node.name];
  const bool twice = std::ranges::any_of(
      same_name, [&](int other) { return component_.nodes[static_cast<std::size_t>(other)].parent == node.parent; });
  if (twice) {
    reader.error("name", fmt::format("there is another node {} with the same parent", node.name), "rename one of them");
    return;
  }
  same_name.push_back(static_cast<int>(component_.nodes.size()));
  component_.nodes.push_back(std::move(node));
}

void NodeReader::finish(Diagnostics& diagnostics) const {
  const auto check_stand_ins = [&](const std::vector<Geometry>& list, int parent) {
    for (const Geometry& geometry : list) {
      for (const std::string& name : geometry.stands_for) {
        const bool known = std::ranges::any_of(component_.nodes, [&](const ComponentNode& node) {
          return node.parent == parent && node.name == name && node.abstract.has_value();
        });
        if (!known)
          diagnostics.error({component_.file, geometry.line, geometry.column},
                            fmt::format("stands_for names {}, which is not a node with an ABSTRACT file below this one",
                                        printable(name)));
      }
    }
  };
  check_stand_ins(component_.geometry, -1);
  for (std::size_t i = 0; i < component_.nodes.size(); ++i) {
    const ComponentNode& node = component_.nodes[i];
    check_stand_ins(node.geometry, static_cast<int>(i));
    if (node.shown == Shown::coarse && node.abstract) check_coarse(node, component_.place(node), diagnostics);
  }
}

void NodeReader::check_coarse(const ComponentNode& node, const Place& place, Diagnostics& diagnostics) const {
  const auto& list =
      node.parent < 0 ? component_.geometry : component_.nodes[static_cast<std::size_t>(node.parent)].geometry;
  const bool stood_for = std::ranges::any_of(list, [&](const Geometry& geometry) {
    return std::ranges::find(geometry.stands_for, node.name) != geometry.stands_for.end();
  });
  if (!stood_for)
    diagnostics.error(
        place, fmt::format("node {} cannot be shown coarsely: it has no stands_for geometry of its father", node.name),
        fmt::format("give one stands_for = [\"{}\"]", node.name));
}

}  // namespace cellmirror
