#include "app/report/status_page.hpp"

#include <nlohmann/json.hpp>

namespace cellmirror::app {

nlohmann::json page_json(const PageReport& report) {
  using nlohmann::json;
  const web::ServerStatus& server = report.server;
  json topics = json::array();
  for (const foxglove::ChannelStatus& one : report.live.channels) {
    topics.push_back(
        {{"topic", one.topic}, {"subscribers", one.subscribers}, {"sent", one.sent}, {"dropped", one.dropped}});
  }
  return {{"on", report.on},
          {"address", report.address.empty() ? json(nullptr) : json(report.address)},
          {"problem", report.problem},
          {"listens_on", report.listens_on},
          {"read_only", report.read_only},
          {"clients", server.clients},
          {"requests", server.requests},
          {"pictures", server.pictures},
          {"pictures_left_out", server.pictures_left_out},
          {"refused", server.refused},
          {"cut", server.cut},
          {"commands", server.commands},
          {"wrong_tokens", server.wrong_tokens},
          {"unread_tokens", server.unread_tokens},
          {"foxglove", {{"clients", report.live.clients}, {"topics", std::move(topics)}}}};
}

}  // namespace cellmirror::app
