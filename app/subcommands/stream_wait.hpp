// The condition of `cellmirror status --wait`: the streams of robots have a certain state.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace cellmirror::app {

struct StreamWait {
  std::string state;                // of `robots[].stream.state`
  std::vector<std::string> robots;  // ids; none: every robot that is online
};

struct StreamWaitResult {
  std::vector<std::string> there;  // ids of the robots whose stream has the state
  std::string missing;             // a text about the others; empty: nothing is missing
};

// `status`: the JSON document (docs/status.md).
[[nodiscard]] StreamWaitResult look_at_streams(const nlohmann::json& status, const StreamWait& wanted);

}  // namespace cellmirror::app
