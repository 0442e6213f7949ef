// What the gateway counts and measures, in Prometheus' text format, version 0.0.4.
#pragma once

#include <string>

#include "app/report/live_document.hpp"
#include "ipc/web/metrics_text.hpp"
#include "ipc/web/web_server.hpp"

namespace cellmirror::app {

using web::MetricsText;

// `web`: null where the server is not there yet.
[[nodiscard]] std::string metrics_document(const LiveSources& sources, const web::ServerStatus& web);

}  // namespace cellmirror::app
