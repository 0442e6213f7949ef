// The thread that gives robot states to the outputs, each at its rate, in step with the tick.
#pragma once

#include <memory>
#include <thread>
#include <vector>

#include "app/gateway/picture.hpp"
#include "app/gateway/robot_states.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::app {

struct PublishedOutput {
  std::unique_ptr<RobotStateOutput> output;
  Nanoseconds period{0};
};

class Publisher {
 public:
  Publisher(engine::Engine& engine, const PictureBoard& board, const Clock& clock, Nanoseconds tick_period,
            std::vector<PublishedOutput> outputs);
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  [[nodiscard]] const std::vector<PublishedOutput>& outputs() const { return outputs_; }

 private:
  void loop(const std::stop_token& stop);
  // Puts out what is due by `now`; the earliest next due time.
  Timestamp publish_due(Timestamp now);
  void select_sending(const OwnerPicture& picture, std::span<const RobotState> robots);

  engine::Engine& engine_;
  const PictureBoard& board_;
  const Clock& clock_;
  Nanoseconds tick_period_;
  std::vector<PublishedOutput> outputs_;
  std::vector<Timestamp> due_;
  RobotStateBuilder builder_;
  std::vector<RobotState> sending_;
  std::vector<bool> wanted_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
