#include "ipc/control/control_request.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cellmirror {
namespace {

using nlohmann::json;

constexpr std::size_t kMostArguments = 32;
constexpr const char* kForm = R"(send one line such as {"request":"status"})";

std::string plain_text(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string one_line(const json& document) { return document.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

std::optional<std::string> ControlRequest::argument(std::string_view name) const {
  for (const auto& [key, value] : arguments) {
    if (key == name) return value;
  }
  return std::nullopt;
}

Result<ControlRequest> parse_control_request(std::string_view line) {
  try {
    const json document = json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (document.is_discarded() || !document.is_object()) return fail("the request is not a JSON object", kForm);
    const auto name = document.find("request");
    if (name == document.end() || !name->is_string()) return fail("the request has no text member \"request\"", kForm);
    if (document.size() > kMostArguments + 1) {
      return fail(fmt::format("the request has more than {} members", kMostArguments), kForm);
    }
    ControlRequest request;
    request.request = name->get<std::string>();
    for (const auto& [key, value] : document.items()) {
      if (key == "request") continue;
      if (!value.is_string() && !value.is_number() && !value.is_boolean()) {
        return fail("a member of the request is neither text nor a number nor true or false", kForm);
      }
      request.arguments.emplace_back(key, plain_text(value));
    }
    return request;
  } catch (const std::exception& error) {
    return fail(fmt::format("the request cannot be read: {}", error.what()), kForm);
  }
}

std::string control_request_line(const ControlRequest& request) {
  json document;
  for (const auto& [key, value] : request.arguments) document[key] = value;
  document["request"] = request.request;
  return one_line(document);
}

std::string control_error(const Error& error) {
  return one_line(json{{"error", error.what}, {"remedy", error.remedy}});
}

std::optional<Error> control_error_in(std::string_view answer) {
  // Answers can be large; an error's first member is its only key that begins so.
  if (!answer.starts_with(R"({"error":)")) return std::nullopt;
  const json document = json::parse(answer, nullptr, false);
  if (!document.is_object() || !document["error"].is_string()) return std::nullopt;
  return Error{document["error"].get<std::string>(), document.value("remedy", "")};
}

}  // namespace cellmirror
