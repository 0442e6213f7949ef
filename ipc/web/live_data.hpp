// What clients of the Foxglove protocol get from the gateway, beside commands. Implemented in app/. Called by the
// threads of the server, several at once.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/foxglove/client_message.hpp"
#include "ipc/foxglove/topic_feed.hpp"
#include "ipc/web/web_backend.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::web {

inline constexpr std::size_t kMaxAssetBytes = std::size_t{16} << 20;  // of a file

class LiveData {
 public:
  virtual ~LiveData() = default;
  // Outlives the server.
  [[nodiscard]] virtual foxglove::TopicFeed& feed() = 0;
  // All of them as they are now.
  [[nodiscard]] virtual std::vector<foxglove::Parameter> parameters() = 0;
  // `reply` is called once, at once or from another thread, possibly after the end of the server.
  virtual void set_parameter(const foxglove::Parameter& parameter, const CommandOrigin& origin,
                             std::function<void(const Result<void>&)> reply) = 0;
  // The content of the file that `uri` names, at most kMaxAssetBytes. Reads it from the disk.
  [[nodiscard]] virtual Result<std::string> asset(std::string_view uri) = 0;
};

}  // namespace cellmirror::web
