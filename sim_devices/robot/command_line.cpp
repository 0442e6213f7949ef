#include "sim_devices/robot/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "drivers/can/channel/open_channel.hpp"
#include "rt_core/base/text.hpp"
#include "sim_devices/robot/cia402_robots.hpp"
#include "sim_devices/robot/dds_robots.hpp"

namespace cellmirror::sim {
namespace {

struct CommonOptions {
  double rate_hz = 100;
  int robots = 1;
  int first_robot = 1;
  std::string motion = "sine";
  std::vector<std::string> faults;
  std::uint64_t seed = 1;
  double for_s = 0;
  std::string control;
  bool no_input = false;
  int priority = 0;
  bool json = false;
  bool quiet = false;
  bool verbose = false;
};

struct Cia402Options {
  std::vector<std::string> channels{"udp:239.74.163.2:43113"};
  std::string interface = "lo";
  std::string nodes = "1-6";
  bool sync = false;
  double sync_producer_hz = 0;
  std::vector<double> increments{100000.0};
  unsigned heartbeat_ms = 100;
  bool self_starting = false;
  bool with_velocity = false;
  bool follow = false;
};

struct DdsOptions {
  int domain = 0;
  std::string interface_address = "127.0.0.1";
  std::string topic = "rt/joint_states";
  std::vector<std::string> joint_names;
  int joints = 6;
  std::optional<std::string> prefix;
  bool best_effort = false;
  bool no_stamp = false;
  int spread = 1;
  double wait_for_reader_s = 0;
};

constexpr const char* kFooter =
    "Examples:\n"
    "  sim_robot cia402 --channel udp:239.74.163.2:43113 --nodes 1-6 --rate 100 --motion sine:amplitude=0.5,period=4\n"
    "  sim_robot cia402 --channel socketcan:vcan0 --nodes 1-7 --sync --fault loss:p=0.01 --fault bus-off@5..6\n"
    "  sim_robot dds --topic rt/joint_states --joint-names a,b,c --rate 125 --for 10 --json\n"
    "  sim_robot dds --robots 32 --joints 7 --rate 500 --control /tmp/robots.sock\n"
    "  echo 'fault delay:s=0.05@0..3' | sim_robot dds --for 5\n"
    "  sim_robot faults           all faults and their keys\n"
    "  sim_robot motions          all motions\n"
    "  sim_robot commands         what can be told to a running sim_robot\n";

void add_common(CLI::App& app, CommonOptions& options) {
  app.add_option("--rate", options.rate_hz, "samples a second and robot")
      ->check(CLI::Range(0.01, 10000.0))
      ->capture_default_str();
  app.add_option("--robots", options.robots, "how many robots")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--first-robot", options.first_robot, "number of the first robot")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--motion", options.motion,
                 "hold, ramp, sine, waypoints:FILE.csv, recorded:FILE.csv; see `sim_robot motions`")
      ->capture_default_str();
  app.add_option("--fault", options.faults,
                 "KIND[:key=value,...][@START..END], may be repeated; see `sim_robot faults`")
      ->allow_extra_args(false);
  app.add_option("--seed", options.seed, "of all chance")->capture_default_str();
  app.add_option("--for", options.for_s, "end after so many seconds; 0: run until quit or a signal")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--control", options.control, "a FIFO to read commands from, or the path of a Unix socket to make");
  app.add_flag("--no-input", options.no_input, "take no commands from standard input");
  app.add_option("--priority", options.priority, "SCHED_FIFO priority of the sending threads, where allowed")
      ->check(CLI::Range(0, 98));
  app.add_flag("--json", options.json, "print the report as JSON on standard output at the end");
  app.add_flag("-q,--quiet", options.quiet, "only errors");
  app.add_flag("-v,--verbose", options.verbose, "what the drivers log as well");
}

void add_cia402(CLI::App& app, Cia402Options& options) {
  app.add_option("--channel", options.channels,
                 "socketcan:IF or udp:GROUP:PORT; when repeated, the robots are dealt out over the channels")
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_option("--interface", options.interface, "udp: the network interface")->capture_default_str();
  app.add_option("--nodes", options.nodes,
                 "node ids of the first robot's joints, e.g. 1-6 or 1,2,5; "
                 "each further robot on the channel has the ids that follow")
      ->capture_default_str();
  app.add_flag("--sync,!--no-sync", options.sync, "send TPDOs with each SYNC instead of by the event timer");
  app.add_option("--sync-producer", options.sync_producer_hz, "produce SYNC so often a second")
      ->check(CLI::Range(0.0, 10000.0));
  app.add_option("--increments-per-rad", options.increments,
                 "increments of object 0x6064 for a rad (or m); "
                 "one value, or one a joint; negative turns it round")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--heartbeat", options.heartbeat_ms, "heartbeat period in ms; 0: none")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_flag("--self-starting", options.self_starting, "operational at once, without an NMT start");
  app.add_flag("--with-velocity", options.with_velocity, "TPDO2 with velocity and torque");
  app.add_flag("--follow", options.follow, "move as commanded over the bus instead of by --motion");
}

void add_dds(CLI::App& app, DdsOptions& options) {
  app.add_option("--domain", options.domain, "DDS domain")->check(CLI::Range(0, 232))->capture_default_str();
  app.add_option("--interface-address", options.interface_address, "IPv4 address of the network interface")
      ->capture_default_str();
  app.add_option("--topic", options.topic, "DDS topic; with {}: a topic a robot, {} is its number")
      ->capture_default_str();
  app.add_option("--joint-names", options.joint_names, "a,b,c")->delimiter(',');
  app.add_option("--joints", options.joints, "without --joint-names: joint_1, joint_2, ...")
      ->check(CLI::Range(1, 128))
      ->capture_default_str();
  app.add_option("--prefix", options.prefix,
                 "before each joint name; {} is the robot's number "
                 "(default: none for one robot, robot{}_ for several on one topic)");
  app.add_flag("--best-effort", options.best_effort, "instead of reliable");
  app.add_flag("--no-stamp", options.no_stamp, "header.stamp stays zero");
  app.add_option("--spread", options.spread, "send the robots of a period in so many groups, evenly spread")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--wait-for-reader", options.wait_for_reader_s,
                 "wait so many seconds at most for a reader, then start")
      ->check(CLI::Range(0.0, 3600.0));
}

ParsedCommandLine refused(int exit_code, const std::string& message) {
  fmt::print(stderr, "sim_robot: {}\n", message);
  return {exit_code, {}};
}

Result<std::vector<FaultSpec>> read_faults(const std::vector<std::string>& texts) {
  std::vector<FaultSpec> faults;
  std::string problems;
  for (const std::string& text : texts) {
    auto fault = parse_fault(text);
    if (fault) {
      faults.push_back(std::move(*fault));
    } else {
      problems += (problems.empty() ? "" : "\nsim_robot: ") + fault.error().text();
    }
  }
  if (!problems.empty()) return fail(problems);
  return faults;
}

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

Result<Job> make_cia402(const CommonOptions& common, const Cia402Options& options) {
  const auto nodes = parse_nodes(options.nodes);
  if (!nodes) return std::unexpected(nodes.error());
  if (options.increments.size() != 1 && options.increments.size() != nodes->size()) {
    return fail(
        fmt::format("--increments-per-rad has {} values for {} nodes", options.increments.size(), nodes->size()),
        "give one value, or one a joint");
  }
  for (const double value : options.increments) {
    if (!std::isfinite(value) || value == 0) return fail("--increments-per-rad: a value is zero or not finite");
  }
  auto motion = make_motion(common.motion, nodes->size());
  if (!motion) return std::unexpected(motion.error());
  const std::shared_ptr<const MotionSource> shared = std::move(*motion);
  Job job;
  for (std::size_t i = 0; i < options.channels.size(); ++i) {
    const auto config = cia402_config(common, options, i, *nodes);
    if (!config) return std::unexpected(config.error());
    if (config->nodes.empty()) continue;
    CanChannelConfig channel_config;
    channel_config.endpoint = config->endpoint;
    channel_config.interface = options.interface;
    if (config->endpoint.starts_with("log:")) return fail("a log cannot be sent to", "use socketcan: or udp:");
    auto channel = can::open_can_channel(channel_config);
    if (!channel) return std::unexpected(channel.error());
    job.devices.push_back(std::make_unique<Cia402Robots>(*config, shared, std::move(*channel)));
  }
  return job;
}

Result<Job> make_dds(const CommonOptions& common, const DdsOptions& options) {
  DdsRobotsConfig config;
  config.domain = options.domain;
  config.interface_address = options.interface_address;
  config.topic = options.topic;
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
  auto motion = make_motion(common.motion, config.joint_names.size());
  if (!motion) return std::unexpected(motion.error());
  auto robots = DdsRobots::make(config, std::move(*motion));
  if (!robots) return std::unexpected(robots.error());
  Job job;
  job.wait_for_reader_s = options.wait_for_reader_s;
  job.readers = [device = robots->get()] { return device->matched_readers(); };
  job.devices.push_back(std::move(*robots));
  return job;
}

}  // namespace

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

ParsedCommandLine parse_command_line(int argc, const char* const* argv) {
  CommonOptions common;
  Cia402Options cia402_options;
  DdsOptions dds_options;
  CLI::App app("sim_robot stands in for a robot controller, with every fault on demand.");
  app.require_subcommand(1);
  app.footer(kFooter);
  CLI::App* cia402 = app.add_subcommand("cia402", "drives of CiA 402 on CAN, one a joint");
  CLI::App* dds = app.add_subcommand("dds", "ROS 2 JointState on DDS");
  CLI::App* faults = app.add_subcommand("faults", "print all faults and their keys");
  CLI::App* motions = app.add_subcommand("motions", "print all motions");
  CLI::App* commands = app.add_subcommand("commands", "print what can be told to a running sim_robot");
  add_common(*cia402, common);
  add_cia402(*cia402, cia402_options);
  add_common(*dds, common);
  add_dds(*dds, dds_options);
  for (CLI::App* sub : {cia402, dds}) sub->footer(kFooter);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {app.exit(error) == 0 ? 0 : 2, {}};
  }
  if (faults->parsed() || motions->parsed() || commands->parsed()) {
    fmt::print("{}", faults->parsed() ? fault_help() : motions->parsed() ? motion_help() : control_help());
    return {0, {}};
  }
  auto fault_specs = read_faults(common.faults);
  if (!fault_specs) return refused(2, fault_specs.error().text());
  auto job = cia402->parsed() ? make_cia402(common, cia402_options) : make_dds(common, dds_options);
  if (!job) return refused(1, job.error().text());
  job->runner.kind = cia402->parsed() ? "cia402" : "dds";
  job->runner.faults = std::move(*fault_specs);
  if (common.for_s > 0) job->runner.seconds = common.for_s;
  job->runner.control_path = common.control;
  job->runner.watch_standard_input = !common.no_input;
  job->runner.priority = common.priority;
  job->json = common.json;
  job->quiet = common.quiet;
  job->verbose = common.verbose;
  return {std::nullopt, std::move(*job)};
}

}  // namespace cellmirror::sim
