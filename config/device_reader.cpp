#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/stream_reader.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr double kLargestQuantity = 1e9;
// Positions of drives are 32-bit numbers of increments.
constexpr double kMostIncrements = 2147483647.0;

struct JointUnit {
  const char* length;   // suffix of positions
  const char* inertia;  // key
  const char* torque;   // suffix
  const char* viscous;  // suffix
};
constexpr JointUnit kTurning{"rad", "inertia_kg_m2", "nm", "nm_s_rad"};
constexpr JointUnit kSliding{"m", "mass_kg", "n", "n_s_m"};

std::optional<JointInterval> read_interval(TableReader& reader, const std::string& key) {
  const auto ends = reader.numbers(key, 2);
  if (!ends) return {};
  if ((*ends)[0] < (*ends)[1]) return JointInterval{(*ends)[0], (*ends)[1]};
  reader.error(key, fmt::format("{} ends before it begins", key), "write [lower, upper]");
  return {};
}

void read_gear(TableReader& reader, const JointUnit& unit, DriveConfig& drive) {
  constexpr long long kMost = 0xFFFF'FFFF;
  reader.require("encoder_increments");
  drive.encoder_increments =
      static_cast<std::uint32_t>(reader.integer("encoder_increments", 1, kMost).value_or(drive.encoder_increments));
  drive.gear_motor = static_cast<std::uint32_t>(reader.integer("gear_motor_turns", 1, kMost).value_or(1));
  drive.gear_shaft = static_cast<std::uint32_t>(reader.integer("gear_shaft_turns", 1, kMost).value_or(1));
  drive.unit_per_shaft = 2 * std::numbers::pi;
  if (&unit == &kSliding) {
    reader.require("feed_m");
    drive.unit_per_shaft = reader.number("feed_m", kPositive).value_or(1.0);
  }
}

// What the robot's file says of the joint is the default of the drive's limits.
void read_limits(TableReader& reader, const JointUnit& unit, const KnownLimits& known, DriveConfig& drive) {
  const auto key = [&unit](const char* name, const char* end = "") {
    return fmt::format("{}_{}{}", name, unit.length, end);
  };
  const bool has_range = std::isfinite(known.lower) && std::isfinite(known.upper);
  const JointInterval range{known.lower, known.upper};
  if (has_range) {
    drive.software_limits = range;
    const double margin = 0.02 * (range.upper - range.lower);
    drive.stops = JointInterval{range.lower - margin, range.upper + margin};
  }
  drive.software_limits = read_interval(reader, key("software_limits")).value_or(drive.software_limits);
  if (const auto stops = read_interval(reader, key("stops"))) drive.stops = stops;
  drive.limit_switches = read_interval(reader, key("limit_switches"));
  drive.home_switch = read_interval(reader, key("home_switch"));
  drive.offset = reader.number(key("offset")).value_or(0.0);
  drive.start = reader.number(key("start")).value_or(drive.start);
  if (drive.stops) drive.start = std::clamp(drive.start, drive.stops->lower, drive.stops->upper);
  const double velocity = std::isfinite(known.velocity) ? known.velocity : drive.velocity;
  const double acceleration = std::isfinite(known.acceleration) ? known.acceleration : drive.acceleration;
  drive.velocity = reader.number(key("velocity", "_s"), kPositive).value_or(velocity);
  drive.acceleration = reader.number(key("acceleration", "_s2"), kPositive).value_or(acceleration);
  drive.following_error = reader.number(key("following_error"), kPositive).value_or(drive.following_error);
}

void read_motor(TableReader& reader, const JointUnit& unit, DriveConfig& drive) {
  const auto key = [&unit](const char* name) { return fmt::format("{}_{}", name, unit.torque); };
  constexpr double kMostGain = 1000.0;  // 1/s; the loops run at 2 kHz
  constexpr double kMostPeak = 65.0;    // object 0x6072 counts thousandths in 16 bits
  drive.inertia = reader.number(unit.inertia, {1e-9, kLargestQuantity}).value_or(drive.inertia);
  // Without a figure: twice what the acceleration needs.
  drive.rated_torque = reader.number(key(&unit == &kSliding ? "rated_force" : "rated_torque"), {1e-6, kLargestQuantity})
                           .value_or(2 * drive.inertia * drive.acceleration);
  drive.peak_torque = reader.number("peak_factor", {0.01, kMostPeak}).value_or(drive.peak_torque);
  drive.coulomb_friction = reader.number(key("friction"), kNotNegative).value_or(0.0);
  drive.viscous_friction = reader.number(fmt::format("viscous_friction_{}", unit.viscous), kNotNegative).value_or(0.0);
  constexpr double kLongestBlock = 10.0;  // s
  drive.blocked_after = reader.number("blocked_after_s", {0.0, kLongestBlock}).value_or(drive.blocked_after);
  drive.position_gain = reader.number("position_gain_1_s", {0.1, kMostGain}).value_or(drive.position_gain);
  drive.velocity_gain = reader.number("velocity_gain_1_s", {0.1, kMostGain}).value_or(drive.velocity_gain);
}

void check_range(const TableReader& reader, const DriveConfig& drive) {
  const double scale = drive.increments_per_unit();
  const JointInterval range = drive.stops.value_or(JointInterval{});
  const double farthest = std::max(std::abs(range.lower - drive.offset), std::abs(range.upper - drive.offset));
  if (farthest * scale > kMostIncrements)
    reader.error("encoder_increments", "the joint's range has more increments than 32 bits count",
                 "give fewer encoder_increments");
}

DriveConfig read_drive(TableReader& reader, const RobotFacts* robot) {
  DriveConfig drive;
  drive.place = reader.place();
  reader.require("id");
  drive.node_id = static_cast<std::uint8_t>(reader.integer("id", 1, 127).value_or(0));
  drive.waits_for_lss = reader.boolean("wait_for_lss").value_or(false);
  const auto joint = read_joint_reference(reader, robot);
  JointKind kind = reader.has("feed_m") ? JointKind::prismatic : JointKind::revolute;
  KnownLimits known;
  if (joint) {
    drive.joint = joint->number;
    drive.joint_name = joint->name;
    kind = joint->kind;
    known = robot->joint_limits[joint->number];
    drive.start = robot->joint_starts[joint->number];
  }
  const JointUnit& unit = kind == JointKind::prismatic ? kSliding : kTurning;
  read_gear(reader, unit, drive);
  if (const auto sign = reader.integer("sign", -1, 1)) {
    if (*sign == 0) reader.error("sign", "sign is 0, but must be 1 or -1");
    drive.sign = *sign < 0 ? -1.0 : 1.0;
  }
  read_limits(reader, unit, known, drive);
  read_motor(reader, unit, drive);
  reader.finish();
  check_range(reader, drive);
  return drive;
}

}  // namespace

Cia402DeviceConfig read_cia402_device(TableReader& reader, const RobotFacts* robot, const FileFinder& files) {
  Cia402DeviceConfig config;
  config.place = reader.place();
  config.channel = read_channel(reader, files);
  if (config.channel.endpoint.starts_with("log:"))
    reader.error("channel", "a log answers no controller", "use socketcan:INTERFACE or udp:GROUP:PORT");
  config.ages = read_ages(reader);
  config.plausibility = read_plausibility(reader, config.ages);
  constexpr double kLongest = 0.02;
  config.period = read_seconds(reader, "period_s", kLongest, false).value_or(config.period);
  constexpr auto kShortest = Nanoseconds(500'000);
  if (config.period < kShortest) reader.error("period_s", "period_s is at least 0.0005 s");
  config.heartbeat_ms =
      static_cast<std::uint16_t>(std::lround(reader.number("heartbeat_s", {0.0, 65.535}).value_or(0.0) * 1e3));
  for (TableReader& node : reader.tables("node", kMaxJointsPerRobot)) {
    node.belongs_to("[[device]], above its [[device.node]]", reader.known());
    DriveConfig drive = read_drive(node, robot);
    for (const DriveConfig& other : config.nodes) {
      if (other.node_id == drive.node_id && drive.node_id > 0)
        node.error("id", fmt::format("two nodes have the id {}", drive.node_id));
      if (other.joint == drive.joint && !drive.joint_name.empty() && !other.joint_name.empty())
        node.error("joint", fmt::format("two nodes move {}", drive.joint_name));
    }
    config.nodes.push_back(std::move(drive));
  }
  if (config.nodes.empty()) reader.error({}, "no drives are given", "add [[device.node]] with id and joint");
  return config;
}

std::optional<RobotStream> read_device(TableReader& reader, const RobotDirectory& robots, bool complete,
                                       const FileFinder& files) {
  enum class Protocol : std::uint8_t { cia402 };
  RobotStream device;
  device.place = reader.place();
  const std::size_t errors_before = reader.diagnostics().errors();
  reader.require("robot");
  reader.require("protocol");
  const auto robot = reader.text("robot");
  const RobotFacts* facts = nullptr;
  if (robot) {
    device.robot = *robot;
    reader.set_where("device of " + printable(*robot));
    facts = find_robot(reader, *robot, robots, complete);
  }
  if (!reader.choice<Protocol>("protocol", {{"cia402", Protocol::cia402}})) return std::nullopt;
  device.config = read_cia402_device(reader, facts, files);
  reader.finish();
  const bool sound = reader.diagnostics().errors() == errors_before;
  const std::uint32_t given = joints_given_by(device.config);
  for (std::size_t i = 0; sound && facts != nullptr && i < facts->joint_names.size(); ++i) {
    if ((given >> i & 1U) == 0) device.joints_without_position.push_back(facts->joint_names[i]);
  }
  return device;
}

}  // namespace cellmirror
