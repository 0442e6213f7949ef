// The gateway as clients of the Foxglove protocol see it, beside its topics: parameters and files.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "app/live/live_topics.hpp"
#include "app/snapshot/board.hpp"
#include "app/snapshot/cell_state.hpp"
#include "ipc/web/live_data.hpp"
#include "rt_core/base/home.hpp"

namespace cellmirror::app {

class LiveGateway final : public web::LiveData {
 public:
  // All that is pointed to outlives it.
  struct Parts {
    LiveTopics* topics = nullptr;
    const Board<CellState>* board = nullptr;
    const KismetHome* home = nullptr;
    double loop_rate_hz = 0;
    // Executes a SCRIPT command, as web::Backend does.
    std::function<void(std::string_view command, const web::CommandOrigin& origin,
                       std::function<void(const web::CommandReply&)> reply)>
        execute;
  };

  explicit LiveGateway(Parts parts) : parts_(std::move(parts)) {}

  [[nodiscard]] foxglove::TopicFeed& feed() override { return parts_.topics->feed(); }
  [[nodiscard]] std::vector<foxglove::Parameter> parameters() override;
  void set_parameter(const foxglove::Parameter& parameter, const web::CommandOrigin& origin,
                     std::function<void(const Result<void>&)> reply) override;
  [[nodiscard]] Result<std::string> asset(std::string_view uri) override;

 private:
  // The URDF of all robots, with meshes as files of the cell. Made again when the cell has changed.
  [[nodiscard]] std::string description();

  Parts parts_;
  std::mutex mutex_;  // of what follows
  std::shared_ptr<const CompiledCell> described_;
  std::string description_;
};

}  // namespace cellmirror::app
