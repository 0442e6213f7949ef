// Sends a request to a running gateway.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// Sends one request line, e.g. {"request":"status"}, to the gateway of the instance and returns its JSON document.
// Failures, each with its remedy: no such gateway, not allowed, no answer in time, an answer that was cut short.
[[nodiscard]] Result<std::string> control_request(std::string_view instance, std::string_view request,
                                                  Nanoseconds timeout);
// The same at a given socket; `who` names the gateway in messages.
[[nodiscard]] Result<std::string> control_request_at(const std::filesystem::path& socket, std::string_view who,
                                                     std::string_view request, Nanoseconds timeout);

}  // namespace cellmirror
