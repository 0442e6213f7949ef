#include "sim_devices/robot/command_line.hpp"

#include <fmt/format.h>

#include "config/command_line/command_line.hpp"
#include "sim_devices/motion/motion_source.hpp"
#include "sim_devices/robot/options.hpp"

namespace cellmirror::sim {
namespace {

constexpr const char* kFooter =
    "Examples:\n  sim_robot cia402 --channel udp:239.74.163.2:43113 --nodes 1-6 --rate 100 --motion "
    "sine:amplitude=0.5,period=4\n  sim_robot cia402 --channel socketcan:vcan0 --nodes 1-7 --sync --fault loss:p=0.01 "
    "--fault bus-off@5..6\n  sim_robot dbc --dbc axes.dbc --position Axis1.Angle,Axis2.Angle --units-per-rad 57.29578 "
    "--channel udp:239.74.163.2:43113\n  sim_robot dds --topic rt/joint_states --joint-names a,b,c --rate 125 --for 10 "
    "--json\n  sim_robot rtde --port 30004 --rate 500\n  sim_robot dds --robots 32 --joints 7 --rate 500 --control "
    "/tmp/robots.sock\n  echo 'fault "
    "delay:s=0.05@0..3' | sim_robot dds --for 5\n  sim_robot faults           all faults and their keys\n  sim_robot "
    "motions          all motions\n  sim_robot commands         commands of a running sim_robot\n";

void add_common(cli::Command app, CommonOptions& options) {
  app.option("--rate", options.rate_hz, "samples per second and robot").between(0.01, 10000.0).show_default();
  app.option("--robots", options.robots, "how many robots").between(1, 256).show_default();
  app.option("--first-robot", options.first_robot, "number of the first robot").between(1, 64).show_default();
  app.option("--motion", options.motion,
             "hold, ramp, sine, waypoints:FILE.csv, recorded:FILE.csv; see `sim_robot motions`")
      .show_default();
  app.option("--fault", options.faults, "KIND[:key=value,...][@START..END], may be repeated; see `sim_robot faults`")
      .one_value_each();
  app.option("--seed", options.seed, "of the random numbers").show_default();
  app.option("--for", options.for_s, "end after this many seconds; 0: run until quit or a signal")
      .between(0.0, 1e9)
      .show_default();
  app.option("--control", options.control, "a FIFO to read commands from, or the path of a Unix socket to create");
  app.flag("--no-input", options.no_input, "read no commands from standard input");
  app.option("--priority", options.priority, "SCHED_FIFO priority of the sending threads, where allowed")
      .between(0, 98);
  app.flag("--json", options.json, "print the report as JSON on standard output at the end");
  app.flag("-q,--quiet", options.quiet, "only errors");
  app.flag("-v,--verbose", options.verbose, "also log the drivers");
}

void add_cia402(cli::Command app, Cia402Options& options) {
  app.option("--channel", options.channels,
             "socketcan:IF or udp:GROUP:PORT; when repeated, the channels share the robots")
      .one_value_each()
      .show_default();
  app.option("--interface", options.interface, "udp: the network interface").show_default();
  app.option("--nodes", options.nodes,
             "node ids of the first robot's joints, e.g. 1-6 or 1,2,5; the next robots on the channel have the "
             "following ids")
      .show_default();
  app.flag("--sync,!--no-sync", options.sync, "send TPDOs with each SYNC instead of by the event timer");
  app.option("--sync-producer", options.sync_producer_hz, "produce SYNC at this rate, Hz").between(0.0, 10000.0);
  app.option("--increments-per-rad", options.increments,
             "increments of object 0x6064 per rad (or m); one value, or one per joint; negative reverses it")
      .list_divided_by(',')
      .show_default();
  app.option("--heartbeat", options.heartbeat_ms, "heartbeat period in ms; 0: none").between(0, 65535).show_default();
  app.flag("--self-starting", options.self_starting, "operational at once, without NMT start");
  app.flag("--with-velocity", options.with_velocity, "TPDO2 with velocity and torque");
  app.flag("--follow", options.follow, "move as commanded over the bus instead of by --motion");
}

void add_dbc(cli::Command app, DbcOptions& options) {
  app.option("--channel", options.channel, "socketcan:IF or udp:GROUP:PORT").show_default();
  app.option("--interface", options.interface, "udp: the network interface").show_default();
  app.option("--dbc", options.file, "the DBC file").required();
  app.option("--position", options.positions, "MESSAGE.SIGNAL of each joint, comma separated")
      .list_divided_by(',')
      .required();
  app.option("--velocity", options.velocities, "MESSAGE.SIGNAL of each joint's velocity").list_divided_by(',');
  app.option("--effort", options.efforts, "MESSAGE.SIGNAL of each joint's effort").list_divided_by(',');
  app.option("--e2e", options.protections,
             "MESSAGE:key=value,...: counter and CRC of a message, with the keys of [[stream.e2e]]; may be repeated")
      .one_value_each();
  app.option("--units-per-rad", options.units_per_rad, "the DBC's physical units per rad (or m), e.g. 57.29578 for deg")
      .show_default();
}

void add_dds(cli::Command app, DdsOptions& options) {
  app.option("--domain", options.domain, "DDS domain").between(0, 232).show_default();
  app.option("--interface-address", options.interface_address, "IPv4 address of the network interface").show_default();
  app.option("--topic", options.topic, "topic, /NAME or rt/NAME; with {}: one topic per robot, {} is its number")
      .show_default();
  app.option("--joint-names", options.joint_names, "a,b,c").list_divided_by(',');
  app.option("--joints", options.joints, "without --joint-names: joint_1, joint_2, ...").between(1, 128).show_default();
  app.option("--prefix", options.prefix,
             "before each joint name; {} is the robot's number "
             "(default: none for one robot, robot{}_ for several on one topic)");
  app.option("--identity-ca", options.security.identity_ca, "DDS security: the CA of all identities (PEM)");
  app.option("--certificate", options.security.certificate, "DDS security: of this robot (PEM)");
  app.option("--private-key", options.security.private_key, "DDS security: of the certificate (PEM)");
  app.option("--permissions-ca", options.security.permissions_ca, "DDS security: default is the identity CA");
  app.option("--governance", options.security.governance, "DDS security: signed by the permissions CA (S/MIME)");
  app.option("--permissions", options.security.permissions, "DDS security: likewise");
  app.option("--discovery-servers", options.discovery_servers,
             "ADDRESS:PORT,...: found by DDS discovery servers, numbered by their places")
      .list_divided_by(',');
  app.option("--partition", options.partition, "DDS partition, as `partition` of the cell file's stream");
  app.flag("--best-effort", options.best_effort, "instead of reliable");
  app.flag("--no-stamp", options.no_stamp, "header.stamp stays zero");
  app.option("--spread", options.spread, "send the robots of a period in this many groups, evenly spread")
      .between(1, 64)
      .show_default();
  app.option("--wait-for-reader", options.wait_for_reader_s, "wait at most this many seconds for a reader, then start")
      .between(0.0, 3600.0);
}

void add_rtde(cli::Command app, RtdeOptions& options) {
  app.option("--address", options.address, "IPv4 address to listen on").show_default();
  app.option("--port", options.port, "TCP port").between(1, 65535).show_default();
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

}  // namespace

ParsedCommandLine parse_command_line(int argc, const char* const* argv) {
  CommonOptions common;
  Cia402Options cia402_options;
  DbcOptions dbc_options;
  DdsOptions dds_options;
  RtdeOptions rtde_options;
  cli::CommandLine program("sim_robot simulates a robot controller, with faults on demand.");
  program.require_subcommand();
  program.footer(kFooter);
  cli::Command cia402 = program.subcommand("cia402", "CiA 402 drives on CAN, one per joint");
  cli::Command dbc = program.subcommand("dbc", "signals of a DBC file on CAN");
  cli::Command dds = program.subcommand("dds", "ROS 2 JointState on DDS");
  cli::Command rtde = program.subcommand("rtde", "a controller of Universal Robots (RTDE over TCP)");
  cli::Command faults = program.subcommand("faults", "print all faults and their keys");
  cli::Command motions = program.subcommand("motions", "print all motions");
  cli::Command commands = program.subcommand("commands", "print commands of a running sim_robot");
  add_common(cia402, common);
  add_cia402(cia402, cia402_options);
  add_common(dbc, common);
  add_dbc(dbc, dbc_options);
  add_common(dds, common);
  add_dds(dds, dds_options);
  add_common(rtde, common);
  add_rtde(rtde, rtde_options);
  for (cli::Command sub : {cia402, dbc, dds, rtde}) sub.footer(kFooter);
  if (const std::optional<int> status = program.parse(argc, argv)) return {status, {}};
  if (faults.named() || motions.named() || commands.named()) {
    fmt::print("{}", faults.named() ? fault_help() : motions.named() ? motion_help() : control_help());
    return {0, {}};
  }
  auto fault_specs = read_faults(common.faults);
  if (!fault_specs) return refused(2, fault_specs.error().text());
  auto built = cia402.named() ? build_cia402(common, cia402_options)
               : dbc.named()  ? build_dbc(common, dbc_options)
               : rtde.named() ? build_rtde(common, rtde_options)
                              : build_dds(common, dds_options);
  if (!built) return refused(built.error().exit_code, built.error().error.text());
  Job job;
  job.devices = std::move(built->devices);
  job.readers = std::move(built->readers);
  job.wait_for_reader_s = dds_options.wait_for_reader_s;
  job.runner.kind = cia402.named() ? "cia402" : dbc.named() ? "dbc" : rtde.named() ? "rtde" : "dds";
  job.runner.faults = std::move(*fault_specs);
  if (common.for_s > 0) job.runner.seconds = common.for_s;
  job.runner.control_path = common.control;
  job.runner.watch_standard_input = !common.no_input;
  job.runner.priority = common.priority;
  job.json = common.json;
  job.quiet = common.quiet;
  job.verbose = common.verbose;
  return {std::nullopt, std::move(job)};
}

}  // namespace cellmirror::sim
