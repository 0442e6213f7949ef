// A gateway on MQTT ([mqtt], docs/mqtt.md): its topics with plain JSON, and Sparkplug B over a connection of its own
// where that is wanted, since a connection has one last will only.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/mqtt/json_conversation.hpp"
#include "drivers/mqtt/payloads.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/mqtt_config.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/summary_output.hpp"

namespace cellmirror::mqtt {

// Joint states and collisions. The first are sent at their own rate, however often they are given.
// Its counters are those of the whole gateway.
class StatesOutput : public RobotStateOutput, public FindingsOutput {};

// Never waits for the broker: what it does not take is bounded, see outbox.hpp. Not for the tick (it allocates).
class MqttGateway {
 public:
  // `clock`, of the machine, outlives it. Its threads begin: a broker that is not there is a problem(), no failure.
  MqttGateway(const MqttConfig& config, const Identity& identity, const Clock& clock, CommandHandlers handlers);
  // Says farewell; seconds at most where the broker is slow.
  ~MqttGateway();
  MqttGateway(const MqttGateway&) = delete;
  MqttGateway& operator=(const MqttGateway&) = delete;

  // Both end before the gateway does.
  [[nodiscard]] std::unique_ptr<SummaryOutput> summary_output();
  [[nodiscard]] std::unique_ptr<StatesOutput> states_output();
  // How often the output of states should be given them.
  [[nodiscard]] double states_rate_hz() const;
  // One that was raised, cleared or acknowledged, as a line of the alarms' file. Any thread.
  void alarm(std::string_view line);
  // After this no handler is called. Idempotent; also done at the end.
  void stop();

  // Any thread.
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const;
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string problem() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror::mqtt
