// What the command line of sim_robot says, and the devices that are built from it.
#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "sim_devices/robot/device.hpp"

namespace cellmirror::sim {

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

struct DbcOptions {
  std::string channel = "udp:239.74.163.2:43113";
  std::string interface = "lo";
  std::string file;
  std::vector<std::string> positions;
  std::vector<std::string> velocities;
  std::vector<std::string> efforts;
  double units_per_rad = 1.0;
  std::vector<std::string> protections;
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
  DdsSecurityConfig security = {};
  std::string partition = {};
  std::vector<std::string> discovery_servers = {};  // as in [dds] of a cell file
};

struct RtdeOptions {
  std::string address = "127.0.0.1";
  int port = 30004;
};

// Why nothing can be built. Exit code 2: the arguments do not fit together; 1: what they name does not work.
struct Refusal {
  int exit_code = 1;
  Error error;
};

struct BuiltDevices {
  std::vector<std::unique_ptr<SimulatedDevice>> devices;
  std::function<int()> readers;  // DDS: readers that are matched now
};

[[nodiscard]] std::expected<BuiltDevices, Refusal> build_cia402(const CommonOptions& common,
                                                                const Cia402Options& options);
[[nodiscard]] std::expected<BuiltDevices, Refusal> build_dbc(const CommonOptions& common, const DbcOptions& options);
[[nodiscard]] std::expected<BuiltDevices, Refusal> build_dds(const CommonOptions& common, const DdsOptions& options);
[[nodiscard]] std::expected<BuiltDevices, Refusal> build_rtde(const CommonOptions& common, const RtdeOptions& options);

// A bus to send on, error frames included; a log is refused. `interface` is for udp.
[[nodiscard]] Result<std::unique_ptr<CanChannel>> open_bus(const std::string& endpoint, const std::string& interface);

// "1-6", "1,2,5", "1-3,7": 1..127, each once, in the order given.
[[nodiscard]] Result<std::vector<std::uint8_t>> parse_nodes(std::string_view text);

}  // namespace cellmirror::sim
