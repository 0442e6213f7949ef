// What a cell file says about MQTT ([mqtt], docs/mqtt.md). Plain data: config/ fills it, drivers/mqtt reads it. Paths
// are absolute and already checked.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace cellmirror {

// Sparkplug B (3.0, section 4): the edge node that the gateway is; its devices are the robots.
struct SparkplugConfig {
  std::string group;
  std::string edge_node;
  std::string session_file = {};  // keeps the number of the session (bdSeq) from run to run; empty: it begins at 0
};

struct MqttConfig {
  bool enabled = false;
  std::string broker;  // name or numeric address
  std::uint16_t port = 1883;
  bool tls = false;
  std::string ca_file;      // PEM; empty with TLS: the authorities of the operating system
  std::string certificate;  // PEM, of this client; empty: none
  std::string key;          // of the certificate
  std::string credentials;  // a file of two lines, user and password; empty: none
  std::string client_id;    // empty: made of cell and instance
  std::string prefix = "cellmirror";
  bool old_protocol = false;  // MQTT 3.1.1 in place of 5
  int keep_alive_s = 10;
  double joint_states_hz = 0;  // 0: none
  bool commands = false;
  double commands_per_s = 10;
  std::optional<SparkplugConfig> sparkplug;
};

}  // namespace cellmirror
