#include "config/cell_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numbers>

#include "config/dds_network_reader.hpp"
#include "config/dds_reader.hpp"
#include "config/display_reader.hpp"
#include "config/foot_switch_reader.hpp"
#include "config/haptic_reader.hpp"
#include "config/mqtt_reader.hpp"
#include "config/node_reader.hpp"
#include "config/record_reader.hpp"
#include "config/stream_reader.hpp"
#include "config/web_reader.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror {

namespace {

constexpr Range kOutputRate{0.0, 1000.0, true};
constexpr Range kTissueRate{0.0, 30.0, true};
constexpr Range kGravity{-1000.0, 1000.0};

}  // namespace

std::optional<std::uint32_t> octal(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 8);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size() || value > 0777U) return std::nullopt;
  return value;
}

void QueueOverrides::apply_to(QueueConfig& config) const {
  config.script_key = script_key.value_or(config.script_key);
  config.sensor_key = sensor_key.value_or(config.sensor_key);
  config.reply_key = reply_key.value_or(config.reply_key);
  config.mode = mode.value_or(config.mode);
  config.tcp_force_key = tcp_force_key.value_or(config.tcp_force_key);
  config.sensor_rate_hz = sensor_rate_hz.value_or(config.sensor_rate_hz);
}

bool CellReader::read(std::string_view text) {
  table_ = parse_toml(text, file_, findings);
  if (!table_) return false;
  TableReader top(*table_, file_, "", findings);
  top.format();
  top.require("name");
  name = top.name("name").value_or("");
  description = top.text("description").value_or("");
  root.file = file_;
  root.description = description;
  root.name = name;
  root.geometry = read_geometry(top, files_);
  NodeReader nodes(root, files_, true);
  for (TableReader& node : top.tables("node", kMaxNodes)) nodes.read(node);
  nodes.finish(findings);
  for (const ComponentNode& node : root.nodes) {
    if (!root.geometry.empty() && node.parent < 0 && node.name == root.name)
      findings.error(root.place(node), fmt::format("the node {} has the name of the cell", node.name),
                     "rename one of them: it names the cell's own geometry in results");
    if (node.joint)
      findings.error(root.place(node), fmt::format("the joint {} is in a cell file", node.name),
                     "joints belong to component files with a [robot]");
  }
  if (const auto g = top.numbers("gravity_m_s2", 3, kGravity)) gravity_m_s2 = {(*g)[0], (*g)[1], (*g)[2]};
  read_loop(top);
  dds.security = read_dds(top, files_, ros, dds_network);
  read_dds_output(top);
  mqtt = read_mqtt(top, files_);
  read_queues(top);
  web = read_web(top);
  record = read_record(top);
  pictures = read_display(top, files_, layout_file);
  collision.read(top);
  tissue.read(top, files_);
  read_startup(top);
  read_views(top);
  foot_switches = read_foot_switches(top);
  constexpr std::size_t kMostStreams = kMaxRobots;
  stream_tables_ = top.tables("stream", kMostStreams);
  device_tables_ = top.tables("device", kMostStreams);
  io.read(top);
  haptic_tables_ = top.tables("haptic", kMaxHapticDevices);
  controller_tables_ = top.tables("controller", kMaxRobots);
  top.belongs_to("[loop]", {"rate_hz", "real_time", "priority"});
  top.belongs_to("[[stream]]", {"robot", "kind", "channel", "topic", "dbc", "address"});
  top.belongs_to("[startup]", {"script"});
  top.finish();
  return true;
}

void CellReader::read_streams(const RobotDirectory& robots, bool complete) {
  const auto add = [this](const TableReader& table, RobotStream stream, const char* others) {
    const bool twice = std::ranges::any_of(
        streams, [&](const RobotStream& other) { return !other.robot.empty() && other.robot == stream.robot; });
    if (twice) table.error("robot", fmt::format("there is another {} of {}", others, printable(stream.robot)));
    streams.push_back(std::move(stream));
  };
  for (TableReader& table : stream_tables_) {
    auto stream = read_stream(table, robots, complete, files_);
    if (!stream) continue;
    if (auto* of_dds = std::get_if<DdsStreamConfig>(&stream->config)) of_dds->security = dds.security;
    add(table, std::move(*stream), "stream");
  }
  for (TableReader& table : device_tables_) {
    if (auto device = read_device(table, robots, complete, files_)) add(table, std::move(*device), "stream or device");
  }
  io.read_nodes(robots, complete, files_);
}

void CellReader::read_haptics(const RobotDirectory& robots, bool complete) {
  for (TableReader& table : haptic_tables_) {
    auto haptic = read_haptic(table, robots, complete);
    if (!haptic) continue;
    const auto same_robot = [&](const auto& other) { return other.robot == haptic->robot; };
    if (std::ranges::any_of(haptics, same_robot))
      table.error("robot", fmt::format("there is another haptic device of {}", printable(haptic->robot)));
    if (std::ranges::any_of(streams, same_robot)) {
      table.error("robot", fmt::format("{} has a stream and a haptic device", printable(haptic->robot)),
                  "it can follow one of them: remove the other table");
    }
    const auto same_key = [&](const RobotHaptic& other) { return haptic->key && other.key == haptic->key; };
    if (std::ranges::any_of(haptics, same_key))
      table.error("shm_key", fmt::format("another haptic device has the key {} too", *haptic->key));
    if (haptic->key && haptic->key == foot_switches.key)
      table.error("shm_key", fmt::format("the foot switches have the key {} too", *haptic->key));
    haptics.push_back(std::move(*haptic));
  }
}

void CellReader::read_controllers(const RobotDirectory& robots, bool complete) {
  for (TableReader& table : controller_tables_) {
    auto controller = read_controller(table, robots, complete);
    if (!controller) continue;
    controller->security = dds.security;
    controller->distribution = ros.messages();
    for (const ControllerConfig& other : controllers) {
      if (other.robot == controller->robot)
        table.error("robot", fmt::format("there is another controller of {}", printable(controller->robot)));
      if (other.name == controller->name && !other.name.empty())
        table.error("name", fmt::format("there is another controller /{}", printable(controller->name)));
    }
    controllers.push_back(std::move(*controller));
  }
}

void CellReader::read_loop(TableReader& top) {
  auto table = top.table("loop");
  if (!table) return;
  loop.rate_hz = table->number("rate_hz", {100.0, 4000.0}).value_or(loop.rate_hz);
  loop.real_time = table
                       ->choice<RealTimePolicy>("real_time", {{"require", RealTimePolicy::require},
                                                              {"prefer", RealTimePolicy::prefer},
                                                              {"off", RealTimePolicy::off}})
                       .value_or(loop.real_time);
  loop.priority = static_cast<int>(table->integer("priority", 1, 98).value_or(loop.priority));
  table->finish();
}

void CellReader::read_dds_output(TableReader& top) {
  auto table = top.table("dds_output");
  if (!table) return;
  dds.enabled = table->boolean("enabled").value_or(true);
  constexpr long long kHighestDomain = 232;
  dds.domain = static_cast<int>(table->integer("domain", 0, kHighestDomain).value_or(dds.domain));
  dds.interface_address = read_own_address(*table, "interface_address").value_or(dds.interface_address);
  dds.partition = read_partition(*table, "partition");
  dds.summary_topic = read_topic(*table, "summary_topic").value_or(dds.summary_topic);
  dds.joint_states_topic = read_topic(*table, "joint_states_topic").value_or(dds.joint_states_topic);
  dds.tf_topic = read_topic(*table, "tf_topic").value_or(dds.tf_topic);
  dds.robot_description_topic = read_topic(*table, "robot_description_topic").value_or(dds.robot_description_topic);
  dds.range_topic_prefix = read_topic(*table, "range_topic_prefix").value_or(dds.range_topic_prefix);
  dds.wrench_topic_prefix = read_topic(*table, "wrench_topic_prefix").value_or(dds.wrench_topic_prefix);
  dds.diagnostics_topic = read_topic(*table, "diagnostics_topic").value_or(dds.diagnostics_topic);
  dds.markers_topic = read_topic(*table, "markers_topic").value_or(dds.markers_topic);
  dds.tissue_topic = read_topic(*table, "tissue_topic").value_or(dds.tissue_topic);
  dds.tissue_rate_hz = table->number("tissue_rate_hz", kTissueRate).value_or(dds.tissue_rate_hz);
  constexpr long long kMostTriangles = 100'000;  // 7.2 MB a message
  if (const auto triangles = table->integer("tissue_triangles", 1, kMostTriangles))
    dds.tissue_triangles = static_cast<std::size_t>(*triangles);
  dds.rate_hz = table->number("rate_hz", kOutputRate).value_or(dds.rate_hz);
  read_dds_pictures(*table, dds.pictures);
  table->finish();
}

void CellReader::read_queues(TableReader& top) {
  auto table = top.table("queues");
  if (!table) return;
  const auto key = [&](const char* which) -> std::optional<std::int32_t> {
    const auto value = table->integer(which, 1, 0x7FFF'FFFF);
    if (!value) return std::nullopt;
    return static_cast<std::int32_t>(*value);
  };
  queues.script_key = key("script_key");
  queues.sensor_key = key("sensor_key");
  queues.reply_key = key("reply_key");
  queues.tcp_force_key = key("tcp_force_key");
  if (const auto mode = table->text("mode")) {
    queues.mode = octal(*mode);
    if (!queues.mode)
      table->error("mode", fmt::format("mode \"{}\" is not a valid mode", printable(*mode)),
                   "write e.g. mode = \"0660\"");
  }
  queues.sensor_rate_hz = table->number("sensor_rate_hz", kOutputRate);
  QueueConfig all;
  queues.apply_to(all);
  if (all.script_key == all.sensor_key || all.script_key == all.reply_key || all.sensor_key == all.reply_key)
    table->error({}, "two queues have the same key", "the default keys are 2351, 1990 and 2352");
  table->finish();
}

// Whether the values fit each other and the cell's own defaults is found when the cell is started.
void CellReader::read_views(TableReader& top) {
  constexpr Range kAngle{0.0, std::numbers::pi, true};
  constexpr Range kPlace{-1e4, 1e4};
  for (TableReader& table : top.tables("view", 7)) {
    table.require("id");
    ViewSetting setting;
    setting.id = static_cast<int>(table.integer("id", 0, 6).value_or(0));
    setting.change.viewpoint = table.vector3("viewpoint_m", kPlace);
    setting.change.lookpoint = table.vector3("lookpoint_m", kPlace);
    setting.change.twist = table.number("twist_rad");
    setting.change.opening_angle = table.number("opening_angle_rad", kAngle);
    setting.change.near_distance = table.number("near_m", kNotNegative);
    setting.change.far_distance = table.number("far_m", kPositive);
    const auto& change = setting.change;
    if (change.viewpoint && change.lookpoint && (*change.viewpoint - *change.lookpoint).norm() < 1e-6)
      table.error("viewpoint_m", "the viewpoint is the lookpoint", "choose two different points");
    if (change.near_distance && change.far_distance && *change.near_distance >= *change.far_distance)
      table.error("near_m", "the near plane is not nearer than the far plane");
    table.finish();
    views.push_back(setting);
  }
}

void CellReader::read_startup(TableReader& top) {
  auto table = top.table("startup");
  if (!table) return;
  table->require("script");
  if (const auto script = table->text("script")) {
    startup_script = *script;
    if (const auto found = files_.find(FileUse::script, *script); !found)
      table->error("script", found.error().what, found.error().remedy);
  }
  table->finish();
}

}  // namespace cellmirror
