#include "app/gateway/gateway_mqtt.hpp"

#include <fmt/format.h>

#include <utility>

#include "app/alarms/alarm_line.hpp"
#include "app/gateway/host_name.hpp"
#include "ipc/wire/script_message.hpp"

namespace cellmirror::app {

namespace {

mqtt::CommandHandlers handlers_of(MqttParts parts, const script::CommandSource& source) {
  const auto refused = [refused = std::move(parts.refused), source](std::string_view command, const std::string& why) {
    refused(source, command, why);
  };
  const auto take = [owner = &parts.owner, source, refused](const std::string& command, mqtt::CommandAnswer answer) {
    const auto refuse = [&](const std::string& why) {
      refused(command, why);
      answer(false, why);
    };
    // The same checks as for messages; the answer has its own way.
    const ScriptEnvelope envelope = parse_script_message(command);
    if (command.starts_with('@')) return refuse("a command does not begin with @");
    if (!envelope.text) return refuse(envelope.text.error().text());
    script::ScriptCommand queued{*envelope.text, source, [answer](const Result<std::string>& result) {
                                   answer(result.has_value(), result ? *result : result.error().text());
                                 }};
    if (owner->offer(queued)) return;
    const std::string why = "too many commands wait to be executed; try again";
    refused(command, why);
    queued.reply(fail(why));
  };
  return {.take = take, .refused = refused};
}

}  // namespace

std::unique_ptr<mqtt::MqttGateway> open_mqtt(const MqttConfig& config, MqttParts parts) {
  if (!config.enabled) return nullptr;
  const Clock& clock = parts.clock;
  const mqtt::Identity identity{parts.cell, parts.instance, host_name(), CELLMIRROR_VERSION};
  const auto source = script::CommandSource::mqtt(fmt::format("broker {}:{}", config.broker, config.port));
  return std::make_unique<mqtt::MqttGateway>(config, identity, clock, handlers_of(std::move(parts), source));
}

AlarmLog::Changed report_alarms(mqtt::MqttGateway* gateway) {
  if (gateway == nullptr) return {};
  return [gateway](const std::vector<Alarm>& changed) {
    for (const Alarm& alarm : changed) gateway->alarm(alarm_line_of(alarm));
  };
}

}  // namespace cellmirror::app
