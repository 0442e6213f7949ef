// The monitor page as status shows it.
#pragma once

#include <string>

#include "ipc/foxglove/topic_feed.hpp"
#include "ipc/web/web_server.hpp"

namespace cellmirror::app {

// As of one moment.
struct PageReport {
  bool on = false;
  std::string address;          // "http://127.0.0.1:8420/", without the token; empty: there is no page
  std::string listens_on = {};  // numeric address; loopback unless the cell file sets another one
  std::string problem;          // why a requested page does not exist; empty: no problem
  bool read_only = false;
  web::ServerStatus server;
  foxglove::FeedStatus live;  // clients of the Foxglove protocol
};

}  // namespace cellmirror::app
