#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "config/dds_network_reader.hpp"
#include "config/stream_reader.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

// A file that a stream names; only its existence is checked here, its content by the driver.
std::string read_file_name(TableReader& reader, std::string_view key, const FileFinder& files) {
  const auto name = reader.text(key);
  if (!name) return {};
  const auto found = files.find(FileUse::description, *name);
  if (!found) {
    reader.error(key, found.error().what, found.error().remedy);
    return {};
  }
  return found->string();
}

TpdoConfig read_tpdo(TableReader& reader) {
  TpdoConfig tpdo;
  reader.require("number");
  tpdo.number = static_cast<std::uint8_t>(reader.integer("number", 1, 255).value_or(1));
  tpdo.cob_id = static_cast<std::uint32_t>(reader.integer("cob_id", 0, 0x7FF).value_or(0));
  constexpr int kPredefined = 4;
  if (tpdo.number > kPredefined && tpdo.cob_id == 0 && !reader.has("cob_id"))
    reader.error("number", "only TPDO 1 to 4 have a predefined COB-ID", "give cob_id");
  tpdo.transmission_type = static_cast<std::uint8_t>(reader.integer("transmission_type", 0, 255).value_or(255));
  constexpr double kLongestInhibit = 6.5535;
  constexpr double kLongestTimer = 65.535;
  tpdo.inhibit_time_100us = static_cast<std::uint16_t>(
      std::lround(reader.number("inhibit_time_s", {0.0, kLongestInhibit}).value_or(0.0) * 1e4));
  tpdo.event_timer_ms =
      static_cast<std::uint16_t>(std::lround(reader.number("event_timer_s", {0.0, kLongestTimer}).value_or(0.0) * 1e3));
  constexpr std::size_t kMostEntries = 64;
  int bits = 0;
  for (TableReader& entry : reader.tables("entries", kMostEntries)) {
    PdoEntryConfig config;
    entry.require("bits");
    config.index = static_cast<std::uint16_t>(entry.integer("index", 0, 0xFFFF).value_or(0));
    config.subindex = static_cast<std::uint8_t>(entry.integer("subindex", 0, 255).value_or(0));
    config.bits = static_cast<std::uint8_t>(entry.integer("bits", 1, 64).value_or(8));
    bits += config.bits;
    entry.finish();
    tpdo.entries.push_back(config);
  }
  constexpr int kMostBits = 8 * 64;  // of an FD frame
  if (bits > kMostBits) reader.error("entries", fmt::format("the entries have {} bits, more than {}", bits, kMostBits));
  if (tpdo.entries.empty()) reader.error({}, "a tpdo needs entries = [{ index, subindex, bits }, ...]");
  reader.finish();
  return tpdo;
}

// Exactly one of increments_per_rad and rad_per_increment (or _m).
double read_scale(TableReader& reader, JointKind kind) {
  const bool prismatic = kind == JointKind::prismatic;
  const std::string per_unit = prismatic ? "increments_per_m" : "increments_per_rad";
  const std::string per_increment = prismatic ? "m_per_increment" : "rad_per_increment";
  const auto increments = reader.number(per_unit, {0.0, 1e15, true});
  const auto scale = reader.number(per_increment, {0.0, 1e6, true});
  if (reader.has(per_unit) == reader.has(per_increment)) {
    reader.error({}, reader.has(per_unit) ? "the scale is given twice" : "the scale is not given",
                 fmt::format("give one of {} and {}", per_unit, per_increment));
  }
  if (increments) return 1.0 / *increments;
  return scale.value_or(1.0);
}

// Position range of the drive (object 0x607B) in increments: its position wraps at the ends.
void read_position_range(TableReader& reader, Cia402NodeConfig& node) {
  constexpr long long kMost = 0xFFFF'FFFF;
  const auto lower = reader.integer("position_range_min", -kMost, kMost);
  const auto upper = reader.integer("position_range_max", -kMost, kMost);
  if (!lower && !upper) return;
  if (!lower || !upper || *lower >= *upper) {
    reader.error({}, "position_range_min and position_range_max are not a range",
                 "set both, the smaller first, to the values of object 0x607B of the drive");
    return;
  }
  if (!node.turns && !node.joint_name.empty())
    reader.error("position_range_min", fmt::format("{} is not a continuous joint", node.joint_name),
                 "remove the range, or set the type of the joint to continuous");
  node.range_lower = *lower;
  node.range_upper = *upper;
}

Cia402NodeConfig read_node(TableReader& reader, const RobotFacts* robot, const FileFinder& files) {
  Cia402NodeConfig node;
  node.place = reader.place();
  reader.require("id");
  node.node_id = static_cast<std::uint8_t>(reader.integer("id", 1, 127).value_or(0));
  if (node.node_id > 0) {
    // By its id instead of its number in the file.
    const std::string stream = reader.where().substr(0, reader.where().rfind(", node "));
    reader.set_where(fmt::format("{}, node id {}", stream, node.node_id));
  }
  const auto joint = read_joint_reference(reader, robot);
  // Without a known joint its kind is guessed from the keys, so that only real errors are reported.
  JointKind kind =
      reader.has("increments_per_m") || reader.has("m_per_increment") ? JointKind::prismatic : JointKind::revolute;
  if (joint) {
    node.joint = joint->number;
    node.joint_name = joint->name;
    kind = joint->kind;
  }
  const bool prismatic = kind == JointKind::prismatic;
  node.turns = kind == JointKind::continuous;
  read_position_range(reader, node);
  node.scale = read_scale(reader, kind);
  if (const auto sign = reader.integer("sign", -1, 1)) {
    if (*sign == 0) reader.error("sign", "sign is 0, but must be 1 or -1");
    node.sign = *sign < 0 ? -1.0 : 1.0;
  }
  node.offset = reader.number(prismatic ? "offset_m" : "offset_rad").value_or(0.0);
  node.velocity_scale =
      reader.number(prismatic ? "velocity_m_s_per_unit" : "velocity_rad_s_per_unit", kNotNegative).value_or(0.0);
  node.torque_scale = reader.number(prismatic ? "force_n_per_unit" : "torque_nm_per_unit", kNotNegative).value_or(0.0);
  node.eds_file = read_file_name(reader, "eds", files);
  node.configure = reader.boolean("configure").value_or(false);
  constexpr std::size_t kMostTpdos = 64;
  reader.belongs_to("[[stream.node.tpdo]]", keys_read_by(read_tpdo));
  for (TableReader& tpdo : reader.tables("tpdo", kMostTpdos)) {
    tpdo.belongs_to("[[stream.node]], above its [[stream.node.tpdo]]", reader.known());
    node.tpdos.push_back(read_tpdo(tpdo));
  }
  reader.finish();
  return node;
}

// For keys that stand in the wrong one of these tables: where they belong.
void name_tables_of_keys(TableReader& reader) {
  const auto read = [](TableReader& node) { static_cast<void>(read_node(node, nullptr, AnyFile())); };
  reader.belongs_to("[[stream.node]]", keys_read_by(read));
  reader.belongs_to("[[stream.node]]", keys_read_by(read, toml::table{{"increments_per_m", 1.0}}));
  reader.belongs_to("[[stream.node.tpdo]]", keys_read_by(read_tpdo));
}

template <class Items, class Member>
void refuse_twice(const TableReader& reader, const Items& items, Member member, const char* name) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (std::size_t k = i + 1; k < items.size(); ++k) {
      if (items[i].*member == items[k].*member)
        reader.error({}, fmt::format("two nodes have the same {} {}", name, items[i].*member));
    }
  }
}

DbcSignalConfig read_signal(TableReader& item, const RobotFacts* robot) {
  DbcSignalConfig signal;
  item.require("message");
  item.require("signal");
  signal.place = item.place("signal");
  signal.message_place = item.place("message");
  signal.message = item.text("message").value_or("");
  signal.signal = item.text("signal").value_or("");
  if (const auto joint = read_joint_reference(item, robot)) {
    signal.joint = joint->number;
    signal.joint_name = joint->name;
    signal.turns = joint->kind == JointKind::continuous;
  }
  signal.quantity = item.choice<JointQuantity>("quantity", {{"position", JointQuantity::position},
                                                            {"velocity", JointQuantity::velocity},
                                                            {"effort", JointQuantity::effort}})
                        .value_or(JointQuantity::position);
  signal.scale = item.number("scale").value_or(1.0);
  signal.scale_given = item.has("scale");
  if (signal.scale == 0.0) {
    item.error("scale", "scale is 0", "the value would always be the offset");
    signal.scale = 1.0;  // so that it is reported once
  }
  signal.offset = item.number("offset").value_or(0.0);
  item.finish();
  return signal;
}

// Nothing where the joint is unknown, with an error.
std::string read_ros_joint(TableReader& item, const RobotFacts* robot, DdsJointConfig& joint) {
  std::string own_name;
  if (const auto reference = read_joint_reference(item, robot)) {
    joint.joint = reference->number;
    own_name = reference->name;
  }
  joint.ros_name = item.text("ros_name").value_or(own_name);
  joint.scale = item.number("scale").value_or(1.0);
  if (joint.scale == 0.0) item.error("scale", "scale is 0", "the value would always be the offset");
  joint.offset = item.number("offset").value_or(0.0);
  item.finish();
  return own_name;
}

}  // namespace

Cia402StreamConfig read_cia402(TableReader& reader, const RobotFacts* robot, const FileFinder& files) {
  Cia402StreamConfig config;
  config.place = reader.place();
  config.channel = read_channel(reader, files);
  config.ages = read_ages(reader);
  config.plausibility = read_plausibility(reader, config.ages);
  config.start_nodes = reader.boolean("start_nodes").value_or(true);
  constexpr double kLongest = 60.0;
  config.sync_period = read_seconds(reader, "sync_period_s", kLongest, true).value_or(config.sync_period);
  constexpr auto kShortestSync = Nanoseconds(100'000);
  if (config.sync_period.count() > 0 && config.sync_period < kShortestSync)
    reader.error("sync_period_s", "a SYNC period is at least 0.0001 s, or 0 for none");
  config.heartbeat_timeout =
      read_seconds(reader, "heartbeat_timeout_s", kLongest, true).value_or(config.heartbeat_timeout);
  config.sdo_timeout = read_seconds(reader, "sdo_timeout_s", kLongest, false).value_or(config.sdo_timeout);
  config.heartbeat_producer_ms =
      static_cast<std::uint16_t>(std::lround(reader.number("heartbeat_producer_s", {0.0, 65.535}).value_or(0.0) * 1e3));
  constexpr std::size_t kMostNodes = 127;
  name_tables_of_keys(reader);
  for (TableReader& node : reader.tables("node", kMostNodes)) {
    node.belongs_to("[[stream]], above its [[stream.node]]", reader.known());
    config.nodes.push_back(read_node(node, robot, files));
  }
  if (config.nodes.empty()) reader.error({}, "no drives are given", "add [[stream.node]] with id and joint");
  refuse_twice(reader, config.nodes, &Cia402NodeConfig::node_id, "id");
  if (std::ranges::none_of(config.nodes, [](const auto& node) { return node.joint_name.empty(); }))
    refuse_twice(reader, config.nodes, &Cia402NodeConfig::joint_name, "joint");
  return config;
}

DbcStreamConfig read_dbc(TableReader& reader, const RobotFacts* robot, const FileFinder& files) {
  DbcStreamConfig config;
  config.place = reader.place();
  config.channel = read_channel(reader, files);
  config.ages = read_ages(reader);
  config.plausibility = read_plausibility(reader, config.ages);
  reader.require("dbc");
  config.dbc_file = read_file_name(reader, "dbc", files);
  constexpr std::size_t kMostSignals = 256;
  const auto read_any = [](TableReader& item) { static_cast<void>(read_signal(item, nullptr)); };
  reader.belongs_to("[[stream.signal]]", keys_read_by(read_any));
  for (TableReader& item : reader.tables("signal", kMostSignals)) {
    item.belongs_to("[[stream]], above its [[stream.signal]]", reader.known());
    DbcSignalConfig signal = read_signal(item, robot);
    const bool twice = std::ranges::any_of(config.signals, [&](const DbcSignalConfig& other) {
      return !signal.joint_name.empty() && other.joint_name == signal.joint_name && other.quantity == signal.quantity;
    });
    if (twice) item.error("joint", fmt::format("two signals give the same quantity of {}", signal.joint_name));
    config.signals.push_back(std::move(signal));
  }
  if (config.signals.empty()) reader.error({}, "no signals are given", "add [[stream.signal]]");
  config.protections = read_protections(reader);
  return config;
}

DdsStreamConfig read_dds(TableReader& reader, const RobotFacts* robot) {
  DdsStreamConfig config;
  config.ages = read_ages(reader);
  config.plausibility = read_plausibility(reader, config.ages);
  constexpr long long kHighestDomain = 232;  // DDSI-RTPS: the ports of higher ones do not exist
  config.domain = static_cast<int>(reader.integer("domain", 0, kHighestDomain).value_or(config.domain));
  config.topic = read_topic(reader, "topic").value_or(config.topic);
  if (config.topic.empty()) reader.error("topic", "the topic is empty", "ROS 2's joint states are on /joint_states");
  config.interface_address = read_own_address(reader, "interface_address").value_or(config.interface_address);
  config.reliable = reader.boolean("reliable").value_or(false);
  config.partition = read_partition(reader, "partition");
  constexpr std::size_t kMostJoints = 64;
  const auto read_any = [](TableReader& item) {
    DdsJointConfig ignored;
    static_cast<void>(read_ros_joint(item, nullptr, ignored));
  };
  reader.belongs_to("[[stream.joint]]", keys_read_by(read_any));
  for (TableReader& item : reader.tables("joint", kMostJoints)) {
    item.belongs_to("[[stream]], above its [[stream.joint]]", reader.known());
    DdsJointConfig joint;
    const std::string own_name = read_ros_joint(item, robot, joint);
    const bool twice = !own_name.empty() && std::ranges::any_of(config.joints, [&](const DdsJointConfig& other) {
      return other.joint == joint.joint || other.ros_name == joint.ros_name;
    });
    if (twice) item.error("joint", fmt::format("the joint {} or its ROS name is given twice", own_name));
    config.joints.push_back(std::move(joint));
  }
  if (!reader.has("joint") && robot != nullptr) {
    for (std::size_t i = 0; i < robot->joint_names.size(); ++i) {
      config.joints.push_back({robot->joint_names[i], i, 1.0, 0.0});
    }
  }
  return config;
}

}  // namespace cellmirror
