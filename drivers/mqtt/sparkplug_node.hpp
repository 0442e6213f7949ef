// The edge node of Sparkplug B that a gateway is (specification 3.0.0, sections 4 to 6): its robots are the devices.
// What was not sent is kept in its newest form only. Reports by exception: a metric is sent where its value changed.
// Pure: no lock, no clock, no connection.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/mqtt/outgoing.hpp"
#include "drivers/mqtt/payloads.hpp"
#include "drivers/mqtt/sparkplug_payload.hpp"
#include "rt_core/ports/cell_summary.hpp"
#include "rt_core/ports/mqtt_config.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::mqtt {

class SparkplugNode {
 public:
  // `first_session`: bdSeq of the first session.
  SparkplugNode(const SparkplugConfig& config, const Identity& identity, std::uint8_t first_session = 0);

  // New values.
  void see(const CellSummary& summary);
  void see(const RobotState& robot);

  // A new connection is tried: its last will, NDEATH. The number bdSeq in it is that of the NBIRTH that follows. It is
  // the next one if the broker was asked since.
  [[nodiscard]] Outgoing begin_session(std::int64_t time_ms);
  // The broker was asked for the connection (CONNECT): it may have the last will. Returns the number of the session.
  std::uint8_t asked();
  // The connection stands, its subscription too, or NCMD asks for it: everything is born again.
  void bear_again();
  void disconnected();
  // The next message to send; none: nothing is new.
  [[nodiscard]] std::optional<Outgoing> next(std::int64_t time_ms);
  // NDEATH of the present session, for a connection that is ended on purpose (6.4.21).
  [[nodiscard]] Outgoing death(std::int64_t time_ms) const;

  [[nodiscard]] std::string command_topic() const { return topic("NCMD"); }

 private:
  struct Metric {
    SparkplugType type;
    SparkplugValue value;
    bool changed = true;
  };
  struct Metrics {
    std::map<std::string, Metric> by_name;
    bool born = false;

    void set(const std::string& name, SparkplugType type, SparkplugValue value);
    // The next message is a birth where it has to be one: `all`.
    [[nodiscard]] std::vector<SparkplugMetric> take(bool all);
    [[nodiscard]] bool any_changed() const;
  };
  struct Device {
    Metrics metrics;
    bool told = false;          // DBIRTH was sent in this session
    bool gone = false;          // the newest summary does not have it
    bool has_stream = false;    // it was mirrored since it is known
    bool is_connected = false;  // its values are current: it has DBIRTH, else DDEATH
  };

  [[nodiscard]] std::string topic(std::string_view kind, std::string_view device = {}) const;
  [[nodiscard]] Outgoing message(std::string_view kind, std::string_view device, std::int64_t time_ms,
                                 std::vector<SparkplugMetric> metrics);
  [[nodiscard]] Outgoing node_birth(std::int64_t time_ms);
  [[nodiscard]] std::optional<Outgoing> next_of(const std::string& name, Device& device, std::int64_t time_ms);
  [[nodiscard]] std::optional<Outgoing> next_of_devices(std::int64_t time_ms);

  SparkplugConfig config_;
  Metrics node_;
  std::map<std::string, Device, std::less<>> devices_;  // by robot
  std::string last_device_;                             // that had a turn
  std::uint8_t seq_ = 0;                                // of the next message
  std::uint8_t session_;                                // bdSeq
  bool asked_ = false;                                  // with this number
};

}  // namespace cellmirror::mqtt
