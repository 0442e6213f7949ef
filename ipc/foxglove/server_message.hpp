// Messages of the server in the Foxglove WebSocket protocol, version 1: JSON texts, and the heads of binary messages.
// Pure. Numbers of binary messages are little-endian.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "ipc/foxglove/client_message.hpp"

namespace cellmirror::foxglove {

struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  std::string encoding;  // of messages: "cdr", "json"
  std::string schema_name;
  std::string schema;
  std::string schema_encoding;  // "ros2msg", "jsonschema"
};

// A service whose requests and responses are JSON.
struct Service {
  std::uint32_t id = 0;
  std::string name;
  std::string type;
  std::string request_schema;  // JSON schema
  std::string response_schema;
};

enum class StatusLevel : std::uint8_t { info = 0, warning = 1, error = 2 };

struct ServerInfo {
  std::string name;
  std::map<std::string, std::string> metadata;
  std::string session;  // changes with a restart of the gateway
  // Begin and end of a recording that is played, ns since 1970, UTC: clients may control it. None: real robots.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> played = {};
};

// With the capabilities that this server has: time, parameters and their updates, services, assets.
[[nodiscard]] std::string server_info_message(const ServerInfo& info);
[[nodiscard]] std::string advertise_message(std::span<const Channel> channels);
[[nodiscard]] std::string advertise_services_message(std::span<const Service> services);
// `id`: a later message with the same one takes its place; empty: none.
[[nodiscard]] std::string status_message(StatusLevel level, std::string_view text, std::string_view id = {});
[[nodiscard]] std::string parameters_message(std::span<const Parameter> parameters,
                                             const std::optional<std::string>& request);
[[nodiscard]] std::string service_failed_message(std::uint32_t service, std::uint32_t call, std::string_view why);

inline constexpr std::size_t kDataHead = 13;
// Precedes the bytes of a message. `time_ns`: since 1970, UTC.
[[nodiscard]] std::string data_head(std::uint32_t subscription, std::uint64_t time_ns);
[[nodiscard]] std::string time_message(std::uint64_t time_ns);
[[nodiscard]] std::string service_response(const CallService& of, std::string_view response);
enum class PlaybackWord : std::uint8_t { playing = 0, paused = 1, buffering = 2, ended = 3 };
struct PlaybackReport {
  PlaybackWord word = PlaybackWord::paused;
  std::uint64_t time_ns = 0;  // since 1970, UTC
  double speed = 1;
  bool sought = false;  // the time is another one than that which has passed
};
// `request`: the id of the request that it answers; empty: something else has changed it.
[[nodiscard]] std::string playback_message(const PlaybackReport& report, std::string_view request);
// Precedes the content of a file.
[[nodiscard]] std::string asset_head(std::uint32_t request);
[[nodiscard]] std::string asset_failed_message(std::uint32_t request, std::string_view why);

}  // namespace cellmirror::foxglove
