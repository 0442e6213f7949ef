#include "sim_devices/robot/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "drivers/can/channel/open_channel.hpp"
#include "drivers/dds/network.hpp"
#include "rt_core/base/dds_topic.hpp"
#include "rt_core/base/ipv4_address.hpp"
#include "rt_core/base/text.hpp"
#include "sim_devices/robot/cia402_robots.hpp"
#include "sim_devices/robot/dbc_robot.hpp"
#include "sim_devices/robot/dds_robots.hpp"
#include "sim_devices/robot/error_frame_channel.hpp"
#include "sim_devices/robot/protection.hpp"
#include "sim_devices/robot/rtde_robot.hpp"

namespace cellmirror::sim {
namespace {

std::unexpected<Refusal> wrong_usage(Error error) { return std::unexpected(Refusal{2, std::move(error)}); }
std::unexpected<Refusal> wrong_usage(std::string what, std::string remedy = {}) {
  return wrong_usage(Error{std::move(what), std::move(remedy)});
}
std::unexpected<Refusal> not_working(Error error) { return std::unexpected(Refusal{1, std::move(error)}); }

// Of one channel: robots first..first+count-1, node ids counting on.
Result<Cia402RobotsConfig> cia402_config(const CommonOptions& common, const Cia402Options& options, std::size_t channel,
                                         const std::vector<std::uint8_t>& nodes) {
  Cia402RobotsConfig config;
  const int channels = static_cast<int>(options.channels.size());
  const int index = static_cast<int>(channel);
  const int begin = common.robots * index / channels;
  const int end = common.robots * (index + 1) / channels;
  config.endpoint = options.channels[channel];
  config.first_robot = common.first_robot + begin;
  const int stride = *std::max_element(nodes.begin(), nodes.end()) - *std::min_element(nodes.begin(), nodes.end()) + 1;
  for (int robot = 0; robot < end - begin; ++robot) {
    std::vector<std::uint8_t> ids;
    for (const std::uint8_t node : nodes) {
      const int id = node + robot * stride;
      if (id > 127) {
        return fail(fmt::format("robot {} on {} would have node id {}, beyond 127", config.first_robot + robot,
                                config.endpoint, id),
                    "give more channels, or fewer robots");
      }
      ids.push_back(static_cast<std::uint8_t>(id));
    }
    config.nodes.push_back(std::move(ids));
  }
  config.increments_per_unit = options.increments;
  config.on_sync = options.sync;
  config.with_velocity = options.with_velocity;
  config.self_starting = options.self_starting;
  config.follows_targets = options.follow;
  config.heartbeat_ms = static_cast<std::uint16_t>(options.heartbeat_ms);
  if (options.sync_producer_hz > 0) config.sync_period = Nanoseconds(std::llround(1e9 / options.sync_producer_hz));
  const double period_ms = 1000.0 / common.rate_hz;
  config.sample_period_ms = static_cast<std::uint16_t>(std::clamp(std::round(period_ms), 1.0, 65535.0));
  if (!options.sync && std::abs(period_ms - config.sample_period_ms) > 1e-6 * period_ms) {
    return fail(fmt::format("--rate {}: CANopen's event timer counts whole milliseconds", common.rate_hz),
                "choose 1000/N, e.g. 100, 125, 200, 250, 500, 1000, or use --sync");
  }
  config.seed = common.seed + channel;
  return config;
}

Result<void> add_signals(const std::vector<std::string>& names, JointQuantity quantity, double units_per_rad,
                         std::vector<DbcSignalConfig>& signals) {
  for (std::size_t joint = 0; joint < names.size(); ++joint) {
    const std::size_t dot = names[joint].find('.');
    if (dot == std::string::npos) {
      return fail(fmt::format("'{}' is not a MESSAGE.SIGNAL", printable(names[joint])),
                  "e.g. --position Axis0.Position");
    }
    DbcSignalConfig signal;
    signal.message = names[joint].substr(0, dot);
    signal.signal = names[joint].substr(dot + 1);
    signal.joint = joint;
    signal.quantity = quantity;
    signal.scale = quantity == JointQuantity::effort ? 1.0 : 1.0 / units_per_rad;
    signals.push_back(std::move(signal));
  }
  return {};
}

// All files or none; the library knows absolute paths only.
Result<void> check_security(DdsSecurityConfig& security) {
  if (security == DdsSecurityConfig{}) return {};
  if (security.permissions_ca.empty()) security.permissions_ca = security.identity_ca;
  for (std::string* file : {&security.identity_ca, &security.certificate, &security.private_key,
                            &security.permissions_ca, &security.governance, &security.permissions}) {
    if (file->empty()) {
      return fail("DDS security needs all of its files",
                  "give --identity-ca, --certificate, --private-key, --governance and --permissions");
    }
    std::error_code error;
    const std::filesystem::path at = std::filesystem::canonical(*file, error);
    if (error) return fail(fmt::format("{}: {}", printable(*file), error.message()));
    *file = at.string();
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<CanChannel>> open_bus(const std::string& endpoint, const std::string& interface) {
  if (endpoint.starts_with("log:")) return fail("a log channel cannot send", "use socketcan: or udp:");
  CanChannelConfig config;
  config.endpoint = endpoint;
  config.interface = interface;
  auto channel = can::open_can_channel(config);
  constexpr std::string_view kSocketCan = "socketcan:";
  if (!channel || !endpoint.starts_with(kSocketCan)) return channel;
  return with_error_frames(std::move(*channel), endpoint.substr(kSocketCan.size()));
}

Result<std::vector<std::uint8_t>> parse_nodes(std::string_view text) {
  std::vector<std::uint8_t> nodes;
  const std::string remedy = "write ids from 1 to 127, each once, e.g. 1-6 or 1,2,5";
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view item = trimmed(text.substr(0, comma));
    const std::size_t dash = item.find('-');
    const long long from = parse_integer(item.substr(0, dash)).value_or(0);
    const long long to = dash == std::string_view::npos ? from : parse_integer(item.substr(dash + 1)).value_or(0);
    if (from < 1 || to > 127 || to < from) return fail(fmt::format("nodes '{}'", printable(item)), remedy);
    for (long long id = from; id <= to; ++id) {
      if (std::find(nodes.begin(), nodes.end(), id) != nodes.end())
        return fail(fmt::format("node {} twice", id), remedy);
      nodes.push_back(static_cast<std::uint8_t>(id));
    }
    if (comma == std::string_view::npos) return nodes;
    text = text.substr(comma + 1);
  }
}

std::expected<BuiltDevices, Refusal> build_cia402(const CommonOptions& common, const Cia402Options& options) {
  const auto nodes = parse_nodes(options.nodes);
  if (!nodes) return wrong_usage(nodes.error());
  if (options.increments.size() != 1 && options.increments.size() != nodes->size()) {
    return wrong_usage(
        fmt::format("--increments-per-rad has {} values for {} nodes", options.increments.size(), nodes->size()),
        "give one value, or one per joint");
  }
  for (const double value : options.increments) {
    if (!std::isfinite(value) || value == 0) return wrong_usage("--increments-per-rad: a value is zero or not finite");
  }
  auto motion = make_motion(common.motion, nodes->size());
  if (!motion) return wrong_usage(motion.error());
  const std::shared_ptr<const MotionSource> shared = std::move(*motion);
  BuiltDevices built;
  for (std::size_t i = 0; i < options.channels.size(); ++i) {
    const auto config = cia402_config(common, options, i, *nodes);
    if (!config) return wrong_usage(config.error());
    if (config->nodes.empty()) continue;
    auto channel = open_bus(config->endpoint, options.interface);
    if (!channel) return not_working(channel.error());
    built.devices.push_back(std::make_unique<Cia402Robots>(*config, shared, std::move(*channel)));
  }
  return built;
}

std::expected<BuiltDevices, Refusal> build_dbc(const CommonOptions& common, const DbcOptions& options) {
  if (common.robots != 1) return wrong_usage("--robots: a DBC describes one robot", "start one sim_robot for each");
  if (!std::isfinite(1.0 / options.units_per_rad)) return wrong_usage("--units-per-rad is zero");
  DbcRobotConfig config;
  config.endpoint = options.channel;
  config.robot = common.first_robot;
  config.rate_hz = common.rate_hz;
  config.seed = common.seed;
  config.joints = std::max({options.positions.size(), options.velocities.size(), options.efforts.size()});
  for (const auto& [names, quantity] :
       {std::pair(&options.positions, JointQuantity::position), std::pair(&options.velocities, JointQuantity::velocity),
        std::pair(&options.efforts, JointQuantity::effort)}) {
    if (auto added = add_signals(*names, quantity, options.units_per_rad, config.signals); !added) {
      return wrong_usage(added.error());
    }
  }
  for (const std::string& text : options.protections) {
    auto protection = parse_protection(text);
    if (!protection) return wrong_usage(protection.error());
    config.protections.push_back(std::move(*protection));
  }
  Diagnostics diagnostics;
  const auto dbc = can::read_dbc(options.file, diagnostics);
  if (!dbc) return not_working({diagnostics.text(), {}});
  if (!diagnostics.ok()) fmt::print(stderr, "{}", diagnostics.text());
  auto motion = make_motion(common.motion, config.joints);
  if (!motion) return wrong_usage(motion.error());
  auto channel = open_bus(options.channel, options.interface);
  if (!channel) return not_working(channel.error());
  auto robot = DbcRobot::make(config, *dbc, std::move(*motion), std::move(*channel));
  if (!robot) return not_working(robot.error());
  BuiltDevices built;
  built.devices.push_back(std::move(*robot));
  return built;
}

Result<DdsNetworkConfig> network_of(const std::vector<std::string>& servers) {
  DdsNetworkConfig network;
  std::uint8_t id = 0;
  for (const std::string& text : servers) {
    const auto parsed = parse_ipv4_address(text);
    if (!parsed) return fail("--discovery-servers: " + printable(text) + " is no IPv4 address", "ADDRESS:PORT");
    DdsServer server{.address = parsed->address, .id = id++};
    if (parsed->port != 0) server.port = parsed->port;
    network.discovery_servers.push_back(std::move(server));
  }
  return network;
}

std::expected<BuiltDevices, Refusal> build_dds(const CommonOptions& common, const DdsOptions& options) {
  DdsRobotsConfig config;
  config.domain = options.domain;
  config.interface_address = options.interface_address;
  config.topic = dds_topic(options.topic);
  config.reliable = !options.best_effort;
  config.joint_names = options.joint_names;
  for (int i = 1; options.joint_names.empty() && i <= options.joints; ++i) {
    config.joint_names.push_back("joint_" + std::to_string(i));
  }
  const bool one_topic = config.topic.find("{}") == std::string::npos;
  config.name_prefix = options.prefix.value_or(common.robots > 1 && one_topic ? "robot{}_" : "");
  config.first_robot = common.first_robot;
  config.robots = common.robots;
  config.rate_hz = common.rate_hz;
  config.groups = std::min(options.spread, common.robots);
  config.stamped = !options.no_stamp;
  config.seed = common.seed;
  config.security = options.security;
  config.partition = options.partition;
  auto network = network_of(options.discovery_servers);
  if (!network) return wrong_usage(network.error());
  dds::set_network(*network);
  if (auto complete = check_security(config.security); !complete) return wrong_usage(complete.error());
  auto motion = make_motion(common.motion, config.joint_names.size());
  if (!motion) return wrong_usage(motion.error());
  auto robots = DdsRobots::make(config, std::move(*motion));
  if (!robots) return not_working(robots.error());
  BuiltDevices built;
  built.readers = [device = robots->get()] { return device->matched_readers(); };
  built.devices.push_back(std::move(*robots));
  return built;
}

std::expected<BuiltDevices, Refusal> build_rtde(const CommonOptions& common, const RtdeOptions& options) {
  if (common.robots != 1) return wrong_usage("one controller moves one robot", "start sim_robot rtde once for each");
  auto motion = make_motion(common.motion, rtde::kJoints);
  if (!motion) return wrong_usage(motion.error());
  auto robot = RtdeRobot::make({.address = options.address,
                                .port = static_cast<std::uint16_t>(options.port),
                                .rate_hz = common.rate_hz,
                                .seed = common.seed},
                               std::move(*motion));
  if (!robot) return not_working(robot.error());
  BuiltDevices built;
  built.devices.push_back(std::move(*robot));
  return built;
}

}  // namespace cellmirror::sim
