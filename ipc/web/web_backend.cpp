#include "ipc/web/web_backend.hpp"

#include <array>
#include <utility>

#include "ipc/web/metrics_text.hpp"

namespace cellmirror::web {

MakeDocument Backend::document(std::string_view path, std::string_view /*query*/) {
  using Make = std::string (Backend::*)();
  constexpr std::array<std::pair<std::string_view, Make>, 7> kDocuments = {
      {{"/api/status", &Backend::status_json},
       {"/api/tree", &Backend::tree_json},
       {"/api/commands", &Backend::commands_json},
       {"/api/names", &Backend::names_json},
       {"/api/command-log", &Backend::command_log_json},
       {"/api/alarms", &Backend::alarms_json},
       {"/metrics", &Backend::metrics_text}}};
  for (const auto& [known, make] : kDocuments) {
    if (path != known) continue;
    return [this, one = make, metrics = path == "/metrics"] {
      Document out;
      out.bytes = std::make_shared<const std::string>((this->*one)());
      if (metrics) out.content_type = kMetricsType;
      return out;
    };
  }
  return nullptr;
}

}  // namespace cellmirror::web
