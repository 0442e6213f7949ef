#include "sim_devices/camera/command_line.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "config/command_line/command_line.hpp"
#include "rt_core/base/text.hpp"
#include "sim_devices/base/text_items.hpp"
#include "sim_devices/robot/options.hpp"

namespace cellmirror::sim {
namespace {

constexpr const char* kFooter =
    "Examples:\n  sim_camera_head --camera UMG_Kamera_1 --nodes 21,22\n  sim_camera_head --camera UMG_Kamera_1 --nodes "
    "21,22 --channel socketcan:vcan0 --start 0,-0.63 --speed 0.8,0.5\n  sim_camera_head --camera CAMERA_5 --key "
    "0x434D0001 --fault slow:by=0.2@5..15 --fault loss:p=0.05 --json\n  echo 'fault stuck:joint=1@0..5' | "
    "sim_camera_head --camera UMG_Kamera_1 --for 30\n  sim_camera_head --faults     faults of the head and of its "
    "drives\n  sim_camera_head --commands   commands of a running sim_camera_head\nIn a second shell: CAM_TRACKING "
    "UMG_Kamera_1 on FRAME; CAM_ONLINE UMG_Kamera_1 on (docs/cameras.md).\n";

constexpr double kMostRad = 100;

struct Texts {
  std::string camera;
  std::string key = "1990";
  std::string channel = "udp:239.74.163.2:43113";
  std::string interface = "lo";
  std::string nodes = "1,2";
  std::vector<double> increments{100000.0};
  double rate_hz = 100;
  double sync_hz = 0;
  unsigned heartbeat_ms = 100;
  std::vector<double> start{0, 0};
  std::vector<double> pan_range{-3.0, 3.0};
  std::vector<double> tilt_range{-1.4, 1.4};
  std::vector<double> speed{1.5, 1.5};
  std::vector<double> acceleration{6.0, 6.0};
  std::vector<std::string> faults;
  std::uint64_t seed = 1;
  double for_s = 0;
  std::string control;
  int priority = 0;
  bool sync = false;
  bool self_starting = false;
  bool with_velocity = false;
  bool no_input = false;
  bool show_faults = false;
  bool show_commands = false;
};

void add_head(cli::Command& app, Texts& texts, CameraHeadConfig& config) {
  app.option("--camera", texts.camera, "name of the camera's workframe, as in CAM_ONLINE");
  app.option("--key", texts.key, "of the SENSOR channel: decimal, or hexadecimal with 0x").show_default();
  app.flag("--take", config.take, "remove every record from the channel; default: leave them for other readers");
  app.option("--look-rate", config.look_hz, "polls for records per second").between(1.0, 2000.0).show_default();
  app.option("--start", texts.start, "PAN,TILT at the start, rad").list_divided_by(',').show_default();
  app.option("--pan-range", texts.pan_range, "LEAST,MOST rad: its stops").list_divided_by(',').show_default();
  app.option("--tilt-range", texts.tilt_range, "LEAST,MOST rad").list_divided_by(',').show_default();
  app.option("--speed", texts.speed, "PAN,TILT rad/s").list_divided_by(',').show_default();
  app.option("--acceleration", texts.acceleration, "PAN,TILT rad/s2").list_divided_by(',').show_default();
}

void add_drives(cli::Command& app, Texts& texts) {
  app.option("--channel", texts.channel, "socketcan:IF or udp:GROUP:PORT").show_default();
  app.option("--interface", texts.interface, "udp: the network interface").show_default();
  app.option("--nodes", texts.nodes, "node ids of pan and tilt").show_default();
  app.option("--rate", texts.rate_hz, "samples per second, 1000/N").between(0.1, 1000.0).show_default();
  app.flag("--sync,!--no-sync", texts.sync, "send TPDOs with each SYNC instead of by the event timer");
  app.option("--sync-producer", texts.sync_hz, "produce SYNC at this rate, Hz").between(0.0, 10000.0);
  app.option("--increments-per-rad", texts.increments, "of object 0x6064; one value, or one per axis")
      .list_divided_by(',')
      .show_default();
  app.option("--heartbeat", texts.heartbeat_ms, "heartbeat period in ms; 0: none").between(0, 65535).show_default();
  app.flag("--self-starting", texts.self_starting, "operational at once, without NMT start");
  app.flag("--with-velocity", texts.with_velocity, "TPDO2 with velocity and torque");
}

void add_common(cli::Command& app, Texts& texts, CameraHeadJob& job) {
  app.option("--fault", texts.faults, "KIND[:key=value,...][@START..END], may be repeated; see --faults")
      .one_value_each();
  app.option("--seed", texts.seed, "of the random numbers").show_default();
  app.option("--for", texts.for_s, "end after this many seconds; 0: run until quit or a signal")
      .between(0.0, 1e9)
      .show_default();
  app.option("--control", texts.control, "a FIFO to read commands from, or the path of a Unix socket to create");
  app.flag("--no-input", texts.no_input, "read no commands from standard input");
  app.option("--priority", texts.priority, "SCHED_FIFO priority, where allowed").between(0, 98);
  app.flag("--json", job.json, "print the report as JSON on standard output at the end");
  app.flag("-q,--quiet", job.quiet, "only errors");
  app.flag("-v,--verbose", job.verbose, "also log the drivers");
  app.flag("--faults", texts.show_faults, "print all faults");
  app.flag("--commands", texts.show_commands, "print commands of a running sim_camera_head");
}

// Collects what is wrong, a line each.
class Problems {
 public:
  void add(const std::string& what) { text_ += fmt::format("sim_camera_head: {}\n", what); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

bool is_pair(const std::vector<double>& values) {
  return values.size() == 2 && std::isfinite(values[0]) && std::isfinite(values[1]) &&
         std::abs(values[0]) <= kMostRad && std::abs(values[1]) <= kMostRad;
}

void read_axes(const Texts& texts, HeadConfig& head, Problems& problems) {
  const auto range = [&](const char* name, const std::vector<double>& values, AxisLimits& limits) {
    if (!is_pair(values) || values[0] >= values[1]) {
      problems.add(fmt::format("{} needs LEAST,MOST in rad, e.g. -1.5,1.5", name));
      return;
    }
    limits.least = values[0];
    limits.most = values[1];
  };
  range("--pan-range", texts.pan_range, head.limits[0]);
  range("--tilt-range", texts.tilt_range, head.limits[1]);
  const auto positive = [&](const char* name, const std::vector<double>& values, double AxisLimits::* limit) {
    if (!is_pair(values) || values[0] <= 0 || values[1] <= 0) {
      problems.add(fmt::format("{} needs PAN,TILT, both above 0 and at most {}, e.g. 1.5,1", name, kMostRad));
      return;
    }
    for (std::size_t i = 0; i < kHeadAxes; ++i) head.limits[i].*limit = values[i];
  };
  positive("--speed", texts.speed, &AxisLimits::speed);
  positive("--acceleration", texts.acceleration, &AxisLimits::acceleration);
  if (!is_pair(texts.start)) problems.add("--start needs PAN,TILT in rad, e.g. 0,-0.6");
  for (std::size_t i = 0; i < kHeadAxes && is_pair(texts.start); ++i) head.start[i] = texts.start[i];
}

void read_drives(const Texts& texts, Cia402RobotsConfig& drives, Problems& problems) {
  const auto nodes = parse_nodes(texts.nodes);
  if (!nodes) {
    problems.add(nodes.error().text());
  } else if (nodes->size() != kHeadAxes) {
    problems.add(fmt::format("--nodes names {} drives; a head has two, e.g. 21,22", nodes->size()));
  } else {
    drives.nodes = {*nodes};
  }
  bool scales = texts.increments.size() == 1 || texts.increments.size() == kHeadAxes;
  for (const double value : texts.increments) scales = scales && std::isfinite(value) && value != 0;
  if (!scales) problems.add("--increments-per-rad needs one value or two, none of them zero");
  const double period_ms = 1000.0 / texts.rate_hz;
  if (!texts.sync && std::abs(period_ms - std::round(period_ms)) > 1e-6 * period_ms) {
    problems.add(fmt::format("--rate {}: CANopen's event timer counts whole milliseconds; choose 1000/N, or use --sync",
                             texts.rate_hz));
  }
  drives.endpoint = texts.channel;
  drives.increments_per_unit = texts.increments;
  drives.sample_period_ms = static_cast<std::uint16_t>(std::round(period_ms));
  drives.on_sync = texts.sync;
  drives.with_velocity = texts.with_velocity;
  drives.self_starting = texts.self_starting;
  drives.heartbeat_ms = static_cast<std::uint16_t>(texts.heartbeat_ms);
  if (texts.sync_hz > 0) drives.sync_period = Nanoseconds(std::llround(1e9 / texts.sync_hz));
  drives.seed = texts.seed;
}

void read_faults(const Texts& texts, std::vector<HeadFaultSpec>& of_head, std::vector<FaultSpec>& of_drives,
                 Problems& problems) {
  for (const std::string& text : texts.faults) {
    auto of_motion = parse_head_fault(text);
    auto of_bus = parse_fault(text);
    if (of_motion) {
      of_head.push_back(std::move(*of_motion));
    } else if (of_bus) {
      of_drives.push_back(std::move(*of_bus));
    } else {
      // The nearest valid one, if any.
      const bool motion = is_head_fault(text) || of_motion.error().remedy.starts_with("did you mean");
      problems.add(motion ? of_motion.error().text() : of_bus.error().text());
    }
  }
  if (of_head.size() > PanTiltHead::kMostFaults) problems.add("too many faults");
}

void read_names(const Texts& texts, CameraHeadConfig& config, Problems& problems) {
  if (texts.camera.empty() || texts.camera.size() >= kRecordNameBytes) {
    problems.add("--camera is needed: the name of the camera's workframe, as in CAM_ONLINE");
  }
  config.camera = texts.camera;
  const auto key = parse_integer(texts.key);
  if (!key || *key < 1 || *key > 0xffffffffLL)
    problems.add(fmt::format("--key '{}' is not a key", printable(texts.key)));
  config.key = static_cast<std::int32_t>(static_cast<std::uint32_t>(key.value_or(0)));
}

ParsedCameraHead refused(int exit_code, const std::string& lines) {
  fmt::print(stderr, "{}", lines);
  return {exit_code, {}};
}

}  // namespace

ParsedCameraHead parse_camera_head_command_line(int argc, const char* const* argv) {
  Texts texts;
  CameraHeadConfig config;
  CameraHeadJob job;
  cli::CommandLine app(
      "sim_camera_head simulates a pan-tilt head: it follows the records of CAM_ONLINE, and its drives are mirrored as "
      "a robot.",
      "sim_camera_head");
  app.footer(kFooter);
  add_head(app, texts, config);
  add_drives(app, texts);
  add_common(app, texts, job);
  if (const auto exit_code = app.parse(argc, argv)) return {exit_code, {}};
  if (texts.show_faults || texts.show_commands) {
    fmt::print("{}", texts.show_faults ? head_fault_help() + "\n" + fault_help() : control_help());
    return {0, {}};
  }
  Problems problems;
  std::vector<HeadFaultSpec> head_faults;
  read_names(texts, config, problems);
  read_axes(texts, config.head, problems);
  read_drives(texts, config.drives, problems);
  read_faults(texts, head_faults, job.runner.faults, problems);
  if (!problems.text().empty()) return refused(cli::kExitWrongUsage, problems.text());
  auto channel = open_bus(texts.channel, texts.interface);
  if (!channel) return refused(1, fmt::format("sim_camera_head: {}\n", channel.error().text()));
  job.head = std::make_unique<CameraHead>(config, std::move(*channel));
  for (const HeadFaultSpec& fault : head_faults) static_cast<void>(job.head->add_fault(fault, {}));  // room for all
  job.runner.kind = "camera_head";
  job.runner.program = "sim_camera_head";
  if (texts.for_s > 0) job.runner.seconds = texts.for_s;
  job.runner.control_path = texts.control;
  job.runner.watch_standard_input = !texts.no_input;
  job.runner.priority = texts.priority;
  return {std::nullopt, std::move(job)};
}

}  // namespace cellmirror::sim
