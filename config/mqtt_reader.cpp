#include "config/mqtt_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "rt_core/base/text.hpp"
#include "rt_core/base/utf8.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kLongestHost = 253;  // RFC 1035, 2.3.4, without the trailing dot
constexpr std::size_t kLongestTopic = 256;
constexpr std::uint16_t kPort = 1883;
constexpr std::uint16_t kTlsPort = 8883;

bool is_this_machine(std::string_view broker) {
  return broker.starts_with("127.") || broker == "::1" || broker == "localhost";
}

bool is_host(std::string_view text) {
  return !text.empty() && text.size() <= kLongestHost && text.front() != '-' && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' ||
           c == ':';
  });
}

bool has_control_characters(std::string_view text) {
  for (; !text.empty();) {
    const auto character = utf8_character(text);
    if (!character || is_control_character(character->code)) return true;
    text.remove_prefix(character->bytes);
  }
  return false;
}

// One level of a topic: of Sparkplug (3.0, 4.1.1) neither '/' nor a wildcard may be in it.
bool is_level(std::string_view text) {
  return !text.empty() && text.size() <= kLongestTopic && text.find_first_of("/+#") == std::string_view::npos &&
         !has_control_characters(text);
}

bool is_prefix(std::string_view text) {
  return !text.empty() && text.size() <= kLongestTopic && text.front() != '/' && text.front() != '$' &&
         text.back() != '/' && text.find("//") == std::string_view::npos &&
         text.find_first_of("+#") == std::string_view::npos && !has_control_characters(text);
}

std::string read_file(TableReader& table, std::string_view key, const FileFinder& files, bool secret = false) {
  const auto name = table.text(key);
  if (!name) return {};
  const auto found = files.find(FileUse::security, *name);
  if (!found) {
    table.error(key, found.error().what, found.error().remedy);
    return {};
  }
  if (secret) {
    if (const auto hidden = files.check_private(*found); !hidden)
      table.error(key, hidden.error().what, hidden.error().remedy);
  }
  return found->string();
}

void read_broker(TableReader& table, MqttConfig& config) {
  table.require("broker");
  const auto broker = table.text("broker");
  const bool insecure = table.boolean("insecure").value_or(false);
  if (broker && !is_host(*broker)) {
    table.error("broker",
                fmt::format("\"{}\" is neither a name of a machine nor a numeric address", printable(*broker)),
                "the port has a key of its own: port = 8883");
  }
  config.broker = broker.value_or("localhost");
  const bool here = is_this_machine(config.broker);
  config.tls = (!here && !insecure) || !config.ca_file.empty() || !config.certificate.empty();
  if (insecure && config.tls)
    table.error("insecure", "insecure is set beside a certificate or ca_file", "remove one of them");
  config.port = static_cast<std::uint16_t>(table.integer("port", 1, 65535).value_or(config.tls ? kTlsPort : kPort));
  if (config.tls && config.port == kPort)
    table.error("port", fmt::format("port {} is by convention the one without TLS", kPort),
                "give the broker's port for TLS, 8883 as a rule, or insecure = true where the network may be trusted");
}

void read_names(TableReader& table, MqttConfig& config) {
  config.prefix = table.text("prefix").value_or(config.prefix);
  if (!is_prefix(config.prefix))
    table.error("prefix", fmt::format("\"{}\" cannot begin a topic", printable(config.prefix)),
                "levels with '/' between them, without + and #, e.g. plant/hall_2");
  if (const auto id = table.text("client_id")) {
    config.client_id = *id;
    if (id->empty() || id->size() > kLongestTopic || has_control_characters(*id))
      table.error("client_id", fmt::format("\"{}\" is not the name of a client", printable(*id)),
                  "1 to 256 bytes without control characters");
  }
}

std::optional<SparkplugConfig> read_sparkplug(TableReader& top) {
  auto table = top.table("sparkplug");
  if (!table) return std::nullopt;
  SparkplugConfig out;
  for (const auto& [key, to] : {std::pair{"group", &out.group}, std::pair{"edge_node", &out.edge_node}}) {
    table->require(key);
    const auto name = table->text(key);
    if (name && !is_level(*name))
      table->error(key, fmt::format("\"{}\" cannot be part of a topic of Sparkplug", printable(*name)),
                   "1 to 256 bytes without /, + and #");
    *to = name.value_or("");
  }
  table->finish();
  return out;
}

}  // namespace

MqttConfig read_mqtt(TableReader& top, const FileFinder& files) {
  MqttConfig config;
  auto table = top.table("mqtt");
  if (!table) return config;
  constexpr Range kJointStates{0.0, 50.0};
  constexpr Range kCommands{1.0, 100.0};
  config.enabled = table->boolean("enabled").value_or(true);
  config.ca_file = read_file(*table, "ca_file", files);
  config.certificate = read_file(*table, "certificate", files);
  config.key = read_file(*table, "key", files, true);
  if (table->has("certificate") != table->has("key"))
    table->error(table->has("key") ? "key" : "certificate", "certificate and key belong together", "give both");
  config.credentials = read_file(*table, "credentials", files, true);
  read_broker(*table, config);
  read_names(*table, config);
  config.old_protocol = table->choice<bool>("protocol", {{"5", false}, {"3.1.1", true}}).value_or(false);
  config.keep_alive_s = static_cast<int>(table->integer("keep_alive_s", 5, 600).value_or(config.keep_alive_s));
  config.joint_states_hz = table->number("joint_states_hz", kJointStates).value_or(config.joint_states_hz);
  config.commands = table->boolean("commands").value_or(config.commands);
  config.commands_per_s = table->number("commands_per_s", kCommands).value_or(config.commands_per_s);
  config.sparkplug = read_sparkplug(*table);
  table->finish();
  return config;
}

}  // namespace cellmirror
