// The gateway on MQTT: who it is there, and what becomes of commands that come from there.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "app/alarms/alarm_log.hpp"
#include "app/owner/cell_owner.hpp"
#include "drivers/mqtt/mqtt_gateway.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/mqtt_config.hpp"

namespace cellmirror::app {

struct MqttParts {
  std::string cell;
  std::string instance;
  const Clock& clock;  // of the machine
  CellOwner& owner;
  // With each command that is refused before it reaches the owner, but for those of a flood.
  std::function<void(const script::CommandSource& source, std::string_view command, const std::string& why)> refused;
};

// All of `parts` outlives it. Null where the cell file has no [mqtt], or not enabled.
[[nodiscard]] std::unique_ptr<mqtt::MqttGateway> open_mqtt(const MqttConfig& config, MqttParts parts);
// For AlarmLog::start().
[[nodiscard]] AlarmLog::Changed report_alarms(mqtt::MqttGateway* gateway);

}  // namespace cellmirror::app
