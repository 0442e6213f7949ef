#include "config/io_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/stream_reader.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kMostIoNodes = 16;
constexpr std::size_t kMostBarriers = 64;
constexpr std::size_t kLongestCommand = 1000;  // bytes

// The bit or channel of an entry; an error where another entry has it.
template <class Entries, class Number>
void check_unique(const TableReader& table, const char* key, const Entries& entries, std::size_t number, Number of) {
  const auto same = [&](const auto& other) { return of(other) == number; };
  if (table.has(key) && std::ranges::any_of(entries, same))
    table.error(key, fmt::format("another entry has the {} {} too", key, table.has("channel") ? number + 1 : number));
}

const RobotFacts* read_robot_id(TableReader& table, const RobotDirectory& robots, bool complete, std::string& id) {
  table.require("robot");
  const auto robot = table.text("robot");
  if (!robot) return nullptr;
  id = *robot;
  return find_robot(table, *robot, robots, complete);
}

const char* joint_unit(const std::optional<JointReference>& joint) {
  return joint && joint->kind == JointKind::prismatic ? "m" : "rad";
}

JointInput read_joint_input(TableReader& table, const RobotDirectory& robots, bool complete) {
  JointInput input;
  const RobotFacts* facts = read_robot_id(table, robots, complete, input.robot);
  const auto joint = read_joint_reference(table, facts);
  if (joint) input.joint = joint->number;
  const std::string above_key = fmt::format("above_{}", joint_unit(joint));
  const std::string below_key = fmt::format("below_{}", joint_unit(joint));
  const auto above = table.number(above_key);
  const auto below = table.number(below_key);
  if (joint && above.has_value() == below.has_value())
    table.error({}, fmt::format("a limit switch has {} or {}, and not both", above_key, below_key));
  input.above = above.has_value();
  input.position = above.value_or(below.value_or(0.0));
  return input;
}

JointOutput read_joint_output(TableReader& table, const RobotDirectory& robots, bool complete) {
  JointOutput output;
  const RobotFacts* facts = read_robot_id(table, robots, complete, output.robot);
  const auto joint = read_joint_reference(table, facts);
  if (joint) output.joint = joint->number;
  for (const auto& [name, position] : {std::pair{"on", &output.on}, std::pair{"off", &output.off}}) {
    const std::string key = fmt::format("{}_{}", name, joint_unit(joint));
    if (joint) table.require(key);
    *position = table.number(key).value_or(0.0);
  }
  return output;
}

CommandOutput read_command_output(TableReader& table) {
  CommandOutput output;
  for (const auto& [key, command] : {std::pair{"on", &output.on}, std::pair{"off", &output.off}}) {
    *command = table.text(key).value_or("");
    if (command->size() > kLongestCommand)
      table.error(key, fmt::format("the command has more than {} bytes", kLongestCommand));
  }
  if (output.on.empty() && output.off.empty())
    table.error({}, "the output does nothing", "give robot and joint, or SCRIPT commands as on and off");
  return output;
}

}  // namespace

void IoReader::read(TableReader& top) {
  node_tables_ = top.tables("io_node", kMostIoNodes);
  for (TableReader& table : top.tables("light_barrier", kMostBarriers)) read_barrier(table);
}

void IoReader::read_barrier(TableReader& table) {
  constexpr Range kBeam{0.0, 1.0, true};
  LightBarrier barrier;
  for (const char* key : {"name", "from", "to"}) table.require(key);
  barrier.name = table.name("name").value_or("");
  barrier.from = table.text("from").value_or("");
  barrier.to = table.text("to").value_or("");
  barrier.radius = 0.5 * table.number("beam_m", kBeam).value_or(2 * barrier.radius);
  if (!barrier.from.empty() && barrier.from == barrier.to)
    table.error("to", "the beam begins and ends at the same frame");
  const auto same = [&](const LightBarrier& other) { return other.name == barrier.name; };
  if (!barrier.name.empty() && std::ranges::any_of(barriers, same))
    table.error("name", fmt::format("another light barrier is called {}", barrier.name));
  table.finish();
  places_.push_back({table.place("from"), table.place("to")});
  barriers.push_back(std::move(barrier));
}

void IoReader::read_nodes(const RobotDirectory& robots, bool complete, const FileFinder& files) {
  for (TableReader& table : node_tables_) read_node(table, robots, complete, files);
}

void IoReader::read_node(TableReader& table, const RobotDirectory& robots, bool complete, const FileFinder& files) {
  IoNodeConfig node;
  node.place = table.place();
  table.require("id");
  node.node_id = static_cast<std::uint8_t>(table.integer("id", 1, 127).value_or(0));
  node.waits_for_lss = table.boolean("wait_for_lss").value_or(false);
  node.channel = read_channel(table, files);
  if (node.channel.endpoint.starts_with("log:"))
    table.error("channel", "a log answers no controller", "use socketcan:INTERFACE or udp:GROUP:PORT");
  constexpr double kLongestPeriod = 0.1;
  constexpr auto kShortest = Nanoseconds(500'000);
  node.period = read_seconds(table, "period_s", kLongestPeriod, false).value_or(node.period);
  if (node.period < kShortest) table.error("period_s", "period_s is at least 0.0005 s");
  node.heartbeat_ms =
      static_cast<std::uint16_t>(std::lround(table.number("heartbeat_s", {0.0, 65.535}).value_or(0.0) * 1e3));
  for (TableReader& input : table.tables("input", kIoBits)) read_input(input, robots, complete, node);
  for (TableReader& analogue : table.tables("analogue", kIoAnalogues)) read_analogue(analogue, node);
  for (TableReader& output : table.tables("output", kIoBits)) read_output(output, robots, complete, node);
  table.finish();
  const auto same = [&](const IoNodeConfig& other) {
    return other.node_id == node.node_id && other.channel.endpoint == node.channel.endpoint;
  };
  if (node.node_id > 0 && std::ranges::any_of(nodes, same))
    table.error("id", fmt::format("another I/O node on the channel has the id {}", node.node_id));
  nodes.push_back(std::move(node));
}

void IoReader::read_input(TableReader& table, const RobotDirectory& robots, bool complete, IoNodeConfig& node) {
  DigitalInputConfig input;
  table.require("bit");
  input.bit = static_cast<std::size_t>(table.integer("bit", 0, kIoBits - 1).value_or(0));
  check_unique(table, "bit", node.inputs, input.bit, [](const DigitalInputConfig& other) { return other.bit; });
  input.inverted = table.boolean("inverted").value_or(false);
  if (table.has("robot")) {
    input.source = read_joint_input(table, robots, complete);
  } else {
    table.require("barrier");
    BarrierInput source{table.text("barrier").value_or("")};
    const auto named = [&](const LightBarrier& barrier) { return barrier.name == source.barrier; };
    if (!source.barrier.empty() && std::ranges::none_of(barriers, named))
      table.error("barrier", fmt::format("there is no light barrier {}", printable(source.barrier)),
                  "add a [[light_barrier]] with this name");
    input.source = std::move(source);
  }
  table.finish();
  node.inputs.push_back(std::move(input));
}

void IoReader::read_analogue(TableReader& table, IoNodeConfig& node) {
  AnalogueInputConfig input;
  for (const char* key : {"channel", "sensor", "full_scale_m"}) table.require(key);
  input.channel = static_cast<std::size_t>(table.integer("channel", 1, kIoAnalogues).value_or(1)) - 1;
  check_unique(table, "channel", node.analogues, input.channel,
               [](const AnalogueInputConfig& other) { return other.channel; });
  input.sensor = table.text("sensor").value_or("");
  input.full_scale = table.number("full_scale_m", {0.0, 1e3, true}).value_or(1.0);
  table.finish();
  if (!input.sensor.empty()) sensors_.push_back({input.sensor, table.place("sensor")});
  node.analogues.push_back(std::move(input));
}

void IoReader::read_output(TableReader& table, const RobotDirectory& robots, bool complete, IoNodeConfig& node) {
  DigitalOutputConfig output;
  table.require("bit");
  output.bit = static_cast<std::size_t>(table.integer("bit", 0, kIoBits - 1).value_or(0));
  check_unique(table, "bit", node.outputs, output.bit, [](const DigitalOutputConfig& other) { return other.bit; });
  if (table.has("robot")) {
    output.target = read_joint_output(table, robots, complete);
  } else {
    output.target = read_command_output(table);
  }
  table.finish();
  node.outputs.push_back(std::move(output));
}

void IoReader::complete(const Cell& cell, Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < barriers.size(); ++i) {
    for (auto [path, place] :
         {std::pair{&barriers[i].from, &places_[i].from}, std::pair{&barriers[i].to, &places_[i].to}}) {
      if (path->empty()) continue;
      if (const auto node = cell.find(*path)) {
        *path = cell.path(*node);
        continue;
      }
      const Error error = cell.explain(*path);
      diagnostics.error(*place, error.what, error.remedy);
    }
  }
  if (sensors_.empty()) return;
  const auto compiled = cell.compile();
  for (const NamedSensor& sensor : sensors_) {
    if (std::ranges::find(compiled->sensors, sensor.name, &CompiledSensor::name) != compiled->sensors.end()) continue;
    diagnostics.error(sensor.place, fmt::format("there is no ultrasonic sensor {}", printable(sensor.name)));
  }
}

}  // namespace cellmirror
