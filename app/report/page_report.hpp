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
  std::string listens_on = {};  // numeric address; another one than loopback only where the cell file says so
  std::string problem;          // why there is none although it is wanted; empty: nothing is wrong
  bool read_only = false;
  web::ServerStatus server;
  foxglove::FeedStatus live;  // clients of the Foxglove protocol
};

}  // namespace cellmirror::app
