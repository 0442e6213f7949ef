// Loads a cell: its cell.toml with every component, URDF and referenced file. The keys are described in
// docs/cell-files.md. Not for the tick; any thread, one at a time a call.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/foot_switches.hpp"
#include "config/picture_settings.hpp"
#include "config/record_settings.hpp"
#include "config/tissue_setup.hpp"
#include "config/web_settings.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/collision/settings.hpp"
#include "rt_core/haptics/settings.hpp"
#include "rt_core/ports/controller_config.hpp"
#include "rt_core/ports/dds_network.hpp"
#include "rt_core/ports/display_layout.hpp"
#include "rt_core/ports/io_config.hpp"
#include "rt_core/ports/light_barrier.hpp"
#include "rt_core/ports/mqtt_config.hpp"
#include "rt_core/ports/ros_presence.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/ports/view_change.hpp"

namespace cellmirror {

// Downwards, in the world: the standard value (CGPM 1901).
inline const Eigen::Vector3d kStandardGravity(0.0, 0.0, -9.80665);  // m/s2

struct LoopSettings {
  double rate_hz = 1000.0;  // 100..4000
  RealTimePolicy real_time = RealTimePolicy::prefer;
  int priority = 80;  // of SCHED_FIFO, 1..98
};

// The stream of one robot.
struct RobotStream {
  std::string robot;
  StreamConfig config;
  // Their position comes from nowhere; empty where the table has errors, which may be why.
  std::vector<std::string> joints_without_position = {};
  Place place = {};  // of the table
};

// The haptic device that drives one robot, and the shared memory where its process meets the gateway.
struct RobotHaptic {
  std::string robot;
  haptics::HapticSettings settings;
  bool placed = false;              // xyz_m was given; else its zero is the tip position when it goes online
  double reach_m = 0.006;           // radius around the instrument within which its surroundings are queried
  std::optional<std::int32_t> key;  // none: rob_ela_shm names it
  std::size_t bytes = 512;
  std::uint32_t mode = 0600;
  bool online = false;  // at the start
};

// What the cell file says about the message queues; only what it says.
struct QueueOverrides {
  std::optional<std::int32_t> script_key;
  std::optional<std::int32_t> sensor_key;
  std::optional<std::int32_t> reply_key;
  std::optional<std::int32_t> tcp_force_key;
  std::optional<std::uint32_t> mode;
  std::optional<double> sensor_rate_hz;

  void apply_to(QueueConfig& queues) const;
};

struct LoadedCell {
  std::string name;
  std::string description;
  std::filesystem::path file;  // as given
  KismetHome home;
  Eigen::Vector3d gravity_m_s2 = kStandardGravity;  // in the world
  LoopSettings loop;
  std::vector<RobotStream> streams;  // each of another robot
  std::vector<RobotHaptic> haptics;  // each of another robot, which has no stream
  std::vector<IoNodeConfig> io_nodes;
  std::vector<LightBarrier> barriers;
  std::vector<ControllerConfig> controllers;  // of ROS 2, each of another robot
  FootSwitchSettings foot_switches;
  DdsOutputConfig dds;
  RosPresence ros;
  DdsNetworkConfig dds_network;
  MqttConfig mqtt;
  QueueOverrides queues;
  WebSettings web;
  RecordSettings record;
  PictureSettings pictures;
  collision::Settings collision;  // paths in rules are full paths
  TissueSetup tissue;
  std::vector<ViewSetting> views;
  DisplayLayout layout;                      // of the layout file, else the standard setting
  std::string startup_script;                // name of an existing file in the cell folder's scripts/; empty: none
  std::vector<std::filesystem::path> files;  // that were found: components, meshes, ...; no keys and certificates
  Cell cell;
};

// Called before each file (component or mesh) that is read, on the thread that loads: `done` of `total` files are read,
// `what` is the next one's name. The files are counted first; `total` grows where files appear meanwhile.
using LoadProgress = std::function<void(std::size_t done, std::size_t total, std::string_view what)>;

// Called for each valid stream, also if the cell has errors: its driver's diagnostics.
using StreamCheck = std::function<void(const RobotStream& stream, Diagnostics& diagnostics)>;

// A folder stands for the cell.toml in it; any other path for itself.
[[nodiscard]] std::filesystem::path cell_file_of(const std::filesystem::path& path);

// `path`: the cell file or its folder. Nothing if there is any error; all diagnostics of all files in `diagnostics`,
// each with file:line:column.
[[nodiscard]] std::optional<LoadedCell> load_cell(const std::filesystem::path& path, Diagnostics& diagnostics,
                                                  const LoadProgress& progress = {},
                                                  const StreamCheck& check_stream = {});

// `cellmirror check` of a .toml (with all referenced files), .mpc, .urdf, .mpo, .hyper or .msh file. The cell folder of
// any but .toml is $kis_home, else the nearest folder above it with a cell.toml, else its own folder. Other extensions
// are an error.
void check_file(const std::filesystem::path& path, Diagnostics& diagnostics, const LoadProgress& progress = {});
// Whether check_file() supports the extension.
[[nodiscard]] bool is_checkable(const std::filesystem::path& path);

}  // namespace cellmirror
