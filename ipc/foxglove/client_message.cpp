#include "ipc/foxglove/client_message.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "rt_core/base/text.hpp"
#include "rt_core/base/utf8.hpp"

namespace cellmirror::foxglove {

namespace {

using nlohmann::json;
using Read = std::expected<ClientMessage, std::string>;

constexpr std::size_t kLongestToken = 256;
constexpr std::size_t kLongestEncoding = 64;

std::unexpected<std::string> refused(std::string why) { return std::unexpected(std::move(why)); }

// Of an object; null: it has no such member.
const json* member(const json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

std::optional<std::uint32_t> number_of(const json* value) {
  if (value == nullptr || !value->is_number_unsigned()) return std::nullopt;
  const auto number = value->get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<std::string> text_of(const json* value, std::size_t longest) {
  if (value == nullptr || !value->is_string()) return std::nullopt;
  const auto& text = value->get_ref<const std::string&>();
  if (text.size() > longest) return std::nullopt;
  return text;
}

// The array `name`, of at most kMostOfAMessage elements.
std::expected<const json*, std::string> list_of(const json& object, const char* name) {
  const json* found = member(object, name);
  if (found == nullptr || !found->is_array()) return refused(fmt::format("{} is no array", name));
  if (found->size() > kMostOfAMessage)
    return refused(fmt::format("{} has more than {} elements", name, kMostOfAMessage));
  return found;
}

std::expected<std::vector<std::string>, std::string> names_of(const json& object) {
  const auto list = list_of(object, "parameterNames");
  if (!list) return refused(list.error());
  std::vector<std::string> out;
  for (const json& one : **list) {
    auto name = text_of(&one, kLongestName);
    if (!name) return refused(fmt::format("parameterNames has what is no string of at most {} bytes", kLongestName));
    out.push_back(*std::move(name));
  }
  return out;
}

// The id of a request may be missing.
std::expected<std::optional<std::string>, std::string> request_of(const json& object) {
  const json* found = member(object, "id");
  if (found == nullptr || found->is_null()) return std::optional<std::string>();
  auto text = text_of(found, kLongestName);
  if (!text) return refused(fmt::format("id is no string of at most {} bytes", kLongestName));
  return text;
}

Read read_subscribe(const json& object) {
  const auto list = list_of(object, "subscriptions");
  if (!list) return refused(list.error());
  Subscribe out;
  for (const json& one : **list) {
    if (!one.is_object()) return refused("subscriptions has what is no object");
    const auto id = number_of(member(one, "id"));
    const auto channel = number_of(member(one, "channelId"));
    if (!id || !channel) return refused("a subscription needs id and channelId, whole numbers of 32 bits");
    out.subscriptions.push_back({*id, *channel});
  }
  return out;
}

Read read_unsubscribe(const json& object) {
  const auto list = list_of(object, "subscriptionIds");
  if (!list) return refused(list.error());
  Unsubscribe out;
  for (const json& one : **list) {
    const auto id = number_of(&one);
    if (!id) return refused("subscriptionIds has what is no whole number of 32 bits");
    out.subscriptions.push_back(*id);
  }
  return out;
}

template <class Message>
Read read_names(const json& object) {
  auto names = names_of(object);
  if (!names) return refused(names.error());
  return Message{*std::move(names)};
}

Read read_get(const json& object) {
  auto names = names_of(object);
  if (!names) return refused(names.error());
  auto request = request_of(object);
  if (!request) return refused(request.error());
  return GetParameters{*std::move(names), *std::move(request)};
}

std::optional<ParameterValue> value_of(const json* value) {
  if (value == nullptr || value->is_null()) return ParameterValue();
  if (value->is_boolean()) return ParameterValue(value->get<bool>());
  if (value->is_number()) return ParameterValue(value->get<double>());
  if (auto text = text_of(value, kLongestName)) return ParameterValue(*std::move(text));
  return std::nullopt;
}

Read read_set(const json& object) {
  const auto list = list_of(object, "parameters");
  if (!list) return refused(list.error());
  auto request = request_of(object);
  if (!request) return refused(request.error());
  SetParameters out{{}, *std::move(request)};
  for (const json& one : **list) {
    if (!one.is_object()) return refused("parameters has what is no object");
    auto name = text_of(member(one, "name"), kLongestName);
    if (!name) return refused(fmt::format("a parameter needs a name, a string of at most {} bytes", kLongestName));
    auto value = value_of(member(one, "value"));
    if (!value) return refused(fmt::format("the value of {} is no number, truth value or string", printable(*name)));
    out.parameters.push_back({*std::move(name), *std::move(value)});
  }
  return out;
}

Read read_fetch(const json& object) {
  auto uri = text_of(member(object, "uri"), kLongestName);
  const auto request = number_of(member(object, "requestId"));
  if (!request) return refused("requestId is no whole number of 32 bits");
  if (!uri) return refused(fmt::format("uri is no string of at most {} bytes", kLongestName));
  return FetchAsset{*std::move(uri), *request};
}

template <class Number = std::uint32_t>
Number little_endian(std::string_view bytes) {
  Number out = 0;
  for (std::size_t i = 0; i < sizeof out; ++i)
    out |= Number{static_cast<std::uint8_t>(bytes[i])} << (8 * static_cast<unsigned>(i));
  return out;
}

// Operation, command (0: play, 1: pause), speed (float), whether there is a time, time (ns), length of the id, id.
Read read_playback_control(std::string_view bytes) {
  constexpr std::size_t kHead = 1 + 1 + 4 + 1 + 8 + 4;
  if (bytes.size() < kHead) return refused("the playback control request is too short");
  const auto command = static_cast<std::uint8_t>(bytes[1]);
  if (command > 1) return refused(fmt::format("the playback command {} is not known", unsigned{command}));
  PlaybackControl out;
  out.play = command == 0;
  out.speed = static_cast<double>(std::bit_cast<float>(little_endian(bytes.substr(2))));
  if (!std::isfinite(out.speed)) return refused("the playback speed is not a number");
  if (bytes[6] != 0) out.seek_ns = little_endian<std::uint64_t>(bytes.substr(7));
  const std::size_t length = little_endian(bytes.substr(15));
  if (length > kLongestName || length > bytes.size() - kHead)
    return refused("the playback control request has an id that is longer than the message or 1024 bytes");
  out.request = bytes.substr(kHead, length);
  if (!is_utf8(out.request)) return refused("the id of the playback control request is not UTF-8");
  return out;
}

}  // namespace

Read read_text_message(std::string_view text) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return refused("the message is no JSON object");
  const auto op = text_of(member(object, "op"), kLongestName);
  if (!op) return refused("the message has no op");
  using Reads = Read (*)(const json&);
  constexpr std::array<std::pair<std::string_view, Reads>, 7> kOperations = {
      {{"subscribe", read_subscribe},
       {"unsubscribe", read_unsubscribe},
       {"getParameters", read_get},
       {"setParameters", read_set},
       {"subscribeParameterUpdates", read_names<SubscribeParameters>},
       {"unsubscribeParameterUpdates", read_names<UnsubscribeParameters>},
       {"fetchAsset", read_fetch}}};
  for (const auto& [name, read] : kOperations) {
    if (*op != name) continue;
    auto message = read(object);
    if (!message) return refused(fmt::format("{}: {}", name, message.error()));
    return message;
  }
  return refused(fmt::format("the operation {} is not offered", printable(*op)));
}

Read read_binary_message(std::string_view bytes) {
  constexpr char kServiceCall = 2;
  constexpr std::size_t kHead = 1 + 3 * sizeof(std::uint32_t);
  constexpr char kPlaybackControl = 3;
  if (bytes.empty()) return refused("the binary message is empty");
  if (bytes.front() == kPlaybackControl) return read_playback_control(bytes);
  if (bytes.front() != kServiceCall) {
    return refused(fmt::format("the binary operation {} is not offered",
                               static_cast<unsigned>(static_cast<std::uint8_t>(bytes.front()))));
  }
  if (bytes.size() < kHead) return refused("the call of a service is too short");
  CallService out;
  out.service = little_endian(bytes.substr(1));
  out.call = little_endian(bytes.substr(5));
  const std::size_t encoding = little_endian(bytes.substr(9));
  if (encoding > kLongestEncoding || encoding > bytes.size() - kHead)
    return refused("the call of a service has an encoding that is longer than the message or 64 bytes");
  out.encoding = bytes.substr(kHead, encoding);
  out.payload = bytes.substr(kHead + encoding);
  return out;
}

std::expected<CommandRequest, std::string> read_command_request(std::string_view payload, std::size_t longest_command) {
  const json object = json::parse(payload, nullptr, false);
  if (!object.is_object()) return refused("the request is no JSON object");
  auto command = text_of(member(object, "command"), longest_command);
  if (!command || command->find_first_not_of(" \t\r\n") == std::string::npos ||
      command->find('\0') != std::string::npos) {
    return refused(fmt::format("command is no SCRIPT command of at most {} bytes", longest_command));
  }
  CommandRequest out{*std::move(command), {}};
  const json* token = member(object, "token");
  if (token == nullptr || token->is_null()) return out;
  auto text = text_of(token, kLongestToken);
  if (!text) return refused("token is no string");
  out.token = *std::move(text);
  return out;
}

}  // namespace cellmirror::foxglove
