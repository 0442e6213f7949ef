// Messages on the command topic, with the topic and the data of MQTT 5 that their sender chooses.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/mqtt/json_conversation.hpp"
#include "drivers/mqtt/topics.hpp"
#include "rt_core/base/utf8.hpp"

using namespace cellmirror;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

// The input: one byte of flags, a line with the topic for the answer, the payload.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string_view line = text.substr(0, text.find('\n'));
  const std::string_view payload = text.substr(std::min(text.size(), line.size() + 1));
  const bool retained = (data[0] & 1U) != 0;
  ManualClock clock;
  MqttConfig config;
  config.commands = true;
  int taken = 0;
  const auto talk = std::make_shared<mqtt::JsonConversation>(
      config, mqtt::Identity{"cell", "default", "host", "1"}, clock,
      mqtt::CommandHandlers{.take =
                                [&](std::string command, mqtt::CommandAnswer answer) {
                                  ++taken;
                                  require(command.size() <= mqtt::kMostCommandBytes);
                                  answer(true, command);
                                },
                            .refused = {}},
      [] {});
  talk->received({.topic = "cellmirror/cell/command",
                  .payload = payload,
                  .retained = retained,
                  .response_topic = line,
                  .correlation = (data[0] & 2U) != 0 ? line : std::string_view()});
  require(!retained || taken == 0);
  const auto reply = talk->next();
  require(reply.has_value() != retained);
  if (reply) {
    require(mqtt::Topics("cellmirror", "cell").is_reply(reply->topic) && is_utf8(reply->topic));
    require(is_utf8(reply->payload) && reply->payload.size() < 32'768);
  }
  require(!talk->next());
  const std::string level = mqtt::topic_level(payload);
  require(!level.empty() && is_utf8(level) && level.find_first_of("/+#") == std::string::npos);
  return 0;
}
