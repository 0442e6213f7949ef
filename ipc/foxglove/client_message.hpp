// Messages of clients in the Foxglove WebSocket protocol, version 1. Pure: bytes in, values out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace cellmirror::foxglove {

// Two names for the same messages, newest first.
inline constexpr std::array<std::string_view, 2> kSubprotocols = {"foxglove.sdk.v1", "foxglove.websocket.v1"};

inline constexpr std::size_t kLongestName = 1024;    // bytes of a parameter's name, a URI or the id of a request
inline constexpr std::size_t kMostOfAMessage = 512;  // subscriptions or parameters

// Nothing (monostate): the parameter has no value.
using ParameterValue = std::variant<std::monostate, bool, double, std::string>;
struct Parameter {
  std::string name;
  ParameterValue value;
};

struct Subscription {
  std::uint32_t id = 0;  // the client's
  std::uint32_t channel = 0;
};
struct Subscribe {
  std::vector<Subscription> subscriptions;
};
struct Unsubscribe {
  std::vector<std::uint32_t> subscriptions;
};
// No names: all.
struct GetParameters {
  std::vector<std::string> names;
  std::optional<std::string> request;
};
struct SetParameters {
  std::vector<Parameter> parameters;
  std::optional<std::string> request;
};
struct SubscribeParameters {
  std::vector<std::string> names;
};
struct UnsubscribeParameters {
  std::vector<std::string> names;
};
struct FetchAsset {
  std::string uri;
  std::uint32_t request = 0;
};
struct CallService {
  std::uint32_t service = 0;
  std::uint32_t call = 0;
  std::string encoding;
  std::string payload;
};
// Of a server that plays a recording.
struct PlaybackControl {
  bool play = false;
  double speed = 1;
  std::optional<std::uint64_t> seek_ns;  // since 1970, UTC
  std::string request;                   // its id
};
using ClientMessage = std::variant<Subscribe, Unsubscribe, GetParameters, SetParameters, SubscribeParameters,
                                   UnsubscribeParameters, FetchAsset, CallService, PlaybackControl>;

// Both never throw; their cost is bounded by the length of the bytes. The error says in a sentence what is wrong. What
// this server does not offer (publishing, the connection graph) is refused as unknown operations are.
[[nodiscard]] std::expected<ClientMessage, std::string> read_text_message(std::string_view text);
[[nodiscard]] std::expected<ClientMessage, std::string> read_binary_message(std::string_view bytes);

// The request of the service for SCRIPT commands: {"command": "...", "token": "..."}; the token may be left out.
struct CommandRequest {
  std::string command;
  std::string token;
};
[[nodiscard]] std::expected<CommandRequest, std::string> read_command_request(std::string_view payload,
                                                                              std::size_t longest_command);

}  // namespace cellmirror::foxglove
