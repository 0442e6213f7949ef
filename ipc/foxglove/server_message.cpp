#include "ipc/foxglove/server_message.hpp"

#include <bit>
#include <nlohmann/json.hpp>
#include <utility>

namespace cellmirror::foxglove {

namespace {

using nlohmann::json;

// Text from outside may contain bytes that are not UTF-8.
std::string written(const json& document) { return document.dump(-1, ' ', false, json::error_handler_t::replace); }

void append(std::string& out, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) out += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::string begun(std::uint8_t operation) { return std::string(1, static_cast<char>(operation)); }

json value_of(const ParameterValue& value) {
  if (const auto* truth = std::get_if<bool>(&value)) return *truth;
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;
}

}  // namespace

std::string server_info_message(const ServerInfo& info) {
  json out = {{"op", "serverInfo"},
              {"name", info.name},
              {"capabilities", {"time", "parameters", "parametersSubscribe", "services", "assets"}},
              {"supportedEncodings", {"json"}},
              {"metadata", info.metadata},
              {"sessionId", info.session}};
  if (info.played) {
    constexpr std::uint64_t kSecond_ns = 1'000'000'000;
    const auto time = [](std::uint64_t ns) { return json{{"sec", ns / kSecond_ns}, {"nsec", ns % kSecond_ns}}; };
    out["capabilities"].push_back("playbackControl");
    out["dataStartTime"] = time(info.played->first);
    out["dataEndTime"] = time(info.played->second);
  }
  return written(out);
}

std::string advertise_message(std::span<const Channel> channels) {
  json list = json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding}});
  }
  return written({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string advertise_services_message(std::span<const Service> services) {
  json list = json::array();
  const auto described = [](const std::string& name, const std::string& schema) {
    return json{{"encoding", "json"}, {"schemaName", name}, {"schemaEncoding", "jsonschema"}, {"schema", schema}};
  };
  for (const Service& service : services) {
    list.push_back({{"id", service.id},
                    {"name", service.name},
                    {"type", service.type},
                    {"request", described(service.type + ".Request", service.request_schema)},
                    {"response", described(service.type + ".Response", service.response_schema)}});
  }
  return written({{"op", "advertiseServices"}, {"services", std::move(list)}});
}

std::string status_message(StatusLevel level, std::string_view text, std::string_view id) {
  json out = {{"op", "status"}, {"level", static_cast<int>(level)}, {"message", text}};
  if (!id.empty()) out["id"] = id;
  return written(out);
}

std::string parameters_message(std::span<const Parameter> parameters, const std::optional<std::string>& request) {
  json list = json::array();
  for (const Parameter& parameter : parameters) {
    json one = {{"name", parameter.name}};
    if (!std::holds_alternative<std::monostate>(parameter.value)) one["value"] = value_of(parameter.value);
    if (std::holds_alternative<double>(parameter.value)) one["type"] = "float64";
    list.push_back(std::move(one));
  }
  json out = {{"op", "parameterValues"}, {"parameters", std::move(list)}};
  if (request) out["id"] = *request;
  return written(out);
}

std::string service_failed_message(std::uint32_t service, std::uint32_t call, std::string_view why) {
  return written({{"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", why}});
}

std::string data_head(std::uint32_t subscription, std::uint64_t time_ns) {
  std::string out = begun(1);
  append(out, subscription, 4);
  append(out, time_ns, 8);
  return out;
}

std::string time_message(std::uint64_t time_ns) {
  std::string out = begun(2);
  append(out, time_ns, 8);
  return out;
}

std::string service_response(const CallService& of, std::string_view response) {
  std::string out = begun(3);
  append(out, of.service, 4);
  append(out, of.call, 4);
  append(out, of.encoding.size(), 4);
  return out.append(of.encoding).append(response);
}

std::string playback_message(const PlaybackReport& report, std::string_view request) {
  std::string out = begun(5);
  append(out, std::to_underlying(report.word), 1);
  append(out, report.time_ns, 8);
  append(out, std::bit_cast<std::uint32_t>(static_cast<float>(report.speed)), 4);
  append(out, report.sought ? 1 : 0, 1);
  append(out, request.size(), 4);
  return out.append(request);
}

std::string asset_head(std::uint32_t request) {
  std::string out = begun(4);
  append(out, request, 4);
  append(out, 0, 1);
  append(out, 0, 4);
  return out;
}

std::string asset_failed_message(std::uint32_t request, std::string_view why) {
  std::string out = begun(4);
  append(out, request, 4);
  append(out, 1, 1);
  append(out, why.size(), 4);
  return out.append(why);
}

}  // namespace cellmirror::foxglove
