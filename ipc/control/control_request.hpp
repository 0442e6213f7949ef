// The request line of the control socket: {"request":"status"}, with further members that are text, numbers or
// booleans.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror {

struct ControlRequest {
  std::string request;                                         // "status", ...
  std::vector<std::pair<std::string, std::string>> arguments;  // the other members; numbers and booleans as text

  [[nodiscard]] std::optional<std::string> argument(std::string_view name) const;
};

// Fails, with what is wrong, for anything else than one JSON object with a text member "request" and at most 32 plain
// members.
[[nodiscard]] Result<ControlRequest> parse_control_request(std::string_view line);
// One line, without its line break.
[[nodiscard]] std::string control_request_line(const ControlRequest& request);
// {"error": "...", "remedy": "..."}: how a request is refused.
[[nodiscard]] std::string control_error(const Error& error);
// The error of such an answer, if it is one.
[[nodiscard]] std::optional<Error> control_error_in(std::string_view answer);

}  // namespace cellmirror
