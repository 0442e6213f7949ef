// What a cell file says about the channel to a robot's controller. Plain data: config/ fills it, drivers/ read it.
// Paths are absolute and already checked; numbers are SI. Places are those in the cell file, for what the drivers find.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/device_config.hpp"
#include "rt_core/ports/e2e_config.hpp"
#include "rt_core/ports/plausibility.hpp"

namespace cellmirror {

// Common to all kinds: when a value is too old.
struct StreamAges {
  Nanoseconds stale_after{100'000'000};  // no new value for this long: stale
  Nanoseconds lost_after{1'000'000'000};
};

// "socketcan:can0" | "udp:GROUP:PORT" (python-can's udp_multicast; IPv4 or [IPv6] group) | "log:FILE" (candump log)
struct CanChannelConfig {
  std::string endpoint;
  bool fd = false;
  std::string interface = "lo";          // udp: the network interface that joins the group; loopback by default
  std::vector<std::string> allow_from;   // udp: numeric addresses whose datagrams are taken; empty: all
  bool log_as_fast_as_possible = false;  // log: ignore the time stamps
  bool log_repeat = false;
  bool operator==(const CanChannelConfig&) const = default;
};

// One entry of a PDO: which object, how many bits, in the order of the bits of the frame.
struct PdoEntryConfig {
  std::uint16_t index = 0;  // 0: filler bits
  std::uint8_t subindex = 0;
  std::uint8_t bits = 0;
};

struct TpdoConfig {
  std::uint8_t number = 1;               // 1..4 for the predefined COB-IDs, up to 512 with an explicit one
  std::uint32_t cob_id = 0;              // 0: the predefined one (0x80 + 0x100 * number + node)
  std::uint8_t transmission_type = 255;  // 0..240 with SYNC, 254/255 event driven
  std::uint16_t inhibit_time_100us = 0;
  std::uint16_t event_timer_ms = 0;
  std::vector<PdoEntryConfig> entries;
};

// One drive = one joint.
struct Cia402NodeConfig {
  std::uint8_t node_id = 0;  // 1..127
  std::size_t joint = 0;     // the joint's number in the robot
  std::string joint_name;    // for messages
  // position [rad or m] = sign * raw * scale + offset; raw = object 0x6064 in the drive's increments.
  double scale = 1.0;           // rad (or m) an increment, positive
  double sign = 1.0;            // +1 or -1
  double offset = 0.0;          // rad or m
  double velocity_scale = 0.0;  // rad/s (m/s) a unit of 0x606C; 0: same increments a second as `scale`
  double torque_scale =
      0.0;  // Nm (N) a unit of 0x6077 (often a thousandth of the rated torque); 0: effort is not known
  // True for a continuous joint: 0x6064 is unwrapped where it overflows, at its width in bits or at the ends of the
  // range (0x607B of the drive; both 0: no range).
  bool turns = false;
  std::int64_t range_lower = 0;
  std::int64_t range_upper = 0;
  std::string eds_file;           // an EDS or DCF with the PDO mapping; may be empty
  std::vector<TpdoConfig> tpdos;  // from the cell file; they win over the EDS
  bool configure = false;         // write the mapping to the drive by SDO before NMT start
  Place place = {};               // of the node's table
};

struct Cia402StreamConfig {
  CanChannelConfig channel;
  StreamAges ages;
  PlausibilityConfig plausibility;
  std::vector<Cia402NodeConfig> nodes;
  bool start_nodes = true;     // send NMT start to the nodes, at open and after each boot-up
  Nanoseconds sync_period{0};  // > 0: this stream produces SYNC
  Nanoseconds heartbeat_timeout{
      500'000'000};  // no heartbeat for this long: the node is lost; 0: heartbeats are not watched
  Nanoseconds sdo_timeout{500'000'000};
  std::uint16_t heartbeat_producer_ms = 0;  // > 0 and `configure`: written to object 0x1017 of each node
  Place place = {};                         // of the stream's table
};

// One signal of a DBC = one quantity of one joint.
enum class JointQuantity : std::uint8_t { position, velocity, effort };

struct DbcSignalConfig {
  std::string message;  // name in the DBC
  std::string signal;
  std::size_t joint = 0;
  std::string joint_name;
  JointQuantity quantity = JointQuantity::position;
  // value [SI] = physical * scale + offset; physical = the DBC's own raw * factor + offset.
  double scale = 1.0;
  double offset = 0.0;
  bool scale_given = false;  // the cell file says the scale, so that 1 is meant
  bool turns = false;        // continuous joint: an integer is unwrapped where it overflows
  Place place = {};          // of the signal's name
  Place message_place = {};  // of the message's name
};

struct DbcStreamConfig {
  CanChannelConfig channel;
  StreamAges ages;
  PlausibilityConfig plausibility;
  std::string dbc_file;
  std::vector<DbcSignalConfig> signals;
  std::vector<E2eConfig> protections;  // of messages that carry signals, at most one each
  Place place = {};                    // of the stream's table
};

// DDS Security 1.1 of a participant: all of these files, or none. Certificates and the key are PEM; governance and
// permissions are signed by the permissions CA (S/MIME).
struct DdsSecurityConfig {
  std::string identity_ca;
  std::string certificate;
  std::string private_key;
  std::string permissions_ca;
  std::string governance;
  std::string permissions;

  [[nodiscard]] bool enabled() const { return !identity_ca.empty(); }
  auto operator<=>(const DdsSecurityConfig&) const = default;
};

// ROS 2's sensor_msgs/msg/JointState.
struct DdsJointConfig {
  std::string ros_name;  // as in JointState.name
  std::size_t joint = 0;
  double scale = 1.0;  // value = message * scale + offset
  double offset = 0.0;
};

struct DdsStreamConfig {
  int domain = 0;
  std::string topic = "rt/joint_states";
  std::string interface_address = "127.0.0.1";  // loopback by default
  StreamAges ages;
  PlausibilityConfig plausibility;
  std::vector<DdsJointConfig> joints;
  bool reliable = false;            // best effort matches every publisher
  std::string partition = {};       // of DDS; empty: none, as ROS 2 has it
  DdsSecurityConfig security = {};  // [dds.security]: the same for all streams and outputs
};

// One of the six joints of a controller of Universal Robots.
struct RtdeJointConfig {
  std::size_t joint = 0;
  std::size_t number = 0;  // of the controller's joints, from 0: the base
  double scale = 1.0;      // value = controller's * scale + offset
  double offset = 0.0;
  double torque_nm_per_a = 0.0;  // effort = actual_current * this; 0: effort = the target moment of the controller
};

struct RtdeStreamConfig {
  std::string address = "127.0.0.1";  // numeric, of the controller
  std::uint16_t port = 30004;
  double rate_hz = 125;  // that the controller sends with
  StreamAges ages;
  PlausibilityConfig plausibility;
  std::vector<RtdeJointConfig> joints;
};

// [[device]]: the gateway answers as the drives of the robot, which moves as they move.
struct Cia402DeviceConfig {
  CanChannelConfig channel;
  StreamAges ages;
  PlausibilityConfig plausibility;
  Nanoseconds period{1'000'000};   // of the drives' motion and of the samples
  std::uint16_t heartbeat_ms = 0;  // object 0x1017 of each node at power-on
  std::vector<DriveConfig> nodes;
  Place place = {};  // of the device's table
};

using StreamConfig = std::variant<std::monostate, Cia402StreamConfig, DbcStreamConfig, DdsStreamConfig,
                                  RtdeStreamConfig, Cia402DeviceConfig>;

// The robot's joints (bits) whose position comes with the stream; 0 without a stream.
[[nodiscard]] inline std::uint32_t joints_given_by(const StreamConfig& config) {
  std::uint32_t joints = 0;
  const auto add = [&joints](const auto& items) {
    for (const auto& item : items) joints |= 1U << item.joint;
  };
  if (const auto* drives = std::get_if<Cia402StreamConfig>(&config)) add(drives->nodes);
  if (const auto* device = std::get_if<Cia402DeviceConfig>(&config)) add(device->nodes);
  if (const auto* messages = std::get_if<DdsStreamConfig>(&config)) add(messages->joints);
  if (const auto* robot = std::get_if<RtdeStreamConfig>(&config)) add(robot->joints);
  if (const auto* dbc = std::get_if<DbcStreamConfig>(&config)) {
    for (const DbcSignalConfig& signal : dbc->signals) {
      if (signal.quantity == JointQuantity::position) joints |= 1U << signal.joint;
    }
  }
  return joints;
}

// Pictures as sensor_msgs/CompressedImage; rendered only while there is a reader.
struct DdsPictureConfig {
  std::string topic = "rt/cellmirror/picture/compressed";  // empty: not published
  double rate_hz = 10;
  std::optional<int> view;  // 0 to 6; without it and without a camera the display as SCRIPT has set it
  std::string camera;
  int width = 640;
  int height = 480;
  int quality = 80;  // of the JPEG, 1 to 100
};

// What the gateway publishes on DDS.
struct DdsOutputConfig {
  bool enabled = false;
  int domain = 0;
  std::string interface_address = "127.0.0.1";
  std::string partition = {};                           // of all but the summary; empty: none, as ROS 2 has it
  std::string summary_topic = "rt/cellmirror/summary";  // empty: not published
  std::string joint_states_topic = "rt/cellmirror/joint_states";
  std::string tf_topic = "rt/tf";
  std::string robot_description_topic = "rt/robot_description";  // empty: not published
  // Of what collision tests and sensors found; empty: not published.
  std::string range_topic_prefix = "rt/cellmirror/range";  // a sensor's topic is <prefix>/<id>
  std::string wrench_topic_prefix =
      "rt/cellmirror/tcp_wrench";  // a robot's topic is <prefix>/<id>; empty: not published
  std::string diagnostics_topic = "rt/diagnostics";
  std::string markers_topic = "rt/cellmirror/markers";
  // Deformable objects and the forces on instruments; empty: not published. There in cells that have such objects.
  std::string tissue_topic = "rt/cellmirror/tissue";
  double tissue_rate_hz = 2.0;
  std::size_t tissue_triangles = 10'000;  // of all objects; larger surfaces are sent with fewer
  double rate_hz = 50.0;
  DdsPictureConfig pictures = {};
  DdsSecurityConfig security = {};
};

// The System V queues of an instance, and the shared memory that it has beside those of haptic devices.
struct QueueConfig {
  std::int32_t script_key = 2351;     // manual 1.1
  std::int32_t sensor_key = 1990;     // manual 1.2.1, ROBOT send_on
  std::int32_t reply_key = 2352;      // ours: acknowledgements
  std::int32_t tcp_force_key = 1313;  // manual 1.2.4: force at the TCP
  std::uint32_t mode = 0600;          // permissions of the queues
  double sensor_rate_hz = 50.0;       // robot-parameter messages a second and robot
};

}  // namespace cellmirror
