#include "drivers/dds/trajectory_endpoint.hpp"

#include <fmt/core.h>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "drivers/dds/controller_messages.hpp"
#include "drivers/dds/internal/action_server.hpp"
#include "drivers/dds/internal/bytes_reader.hpp"
#include "drivers/dds/internal/counting_writer.hpp"
#include "drivers/dds/message/dds_message.hpp"
#include "drivers/dds/trajectory_messages.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

namespace {

constexpr int kCommandDepth = 16;
constexpr CountingWriter::Options kStateOptions{.depth = 32, .counts_overwritten = false};

class DdsTrajectoryEndpoint final : public TrajectoryEndpoint {
 public:
  explicit DdsTrajectoryEndpoint(ControllerConfig config)
      : config_(std::move(config)), topic_(fmt::format("rt/{}/joint_trajectory", config_.name)) {
    for (const ControllerJoint& joint : config_.joints) names_.push_back(joint.ros_name);
  }
  ~DdsTrajectoryEndpoint() override { close(); }
  DdsTrajectoryEndpoint(const DdsTrajectoryEndpoint&) = delete;
  DdsTrajectoryEndpoint& operator=(const DdsTrajectoryEndpoint&) = delete;

  Result<void> open(TrajectorySink& sink) override {
    auto participant = Participant::shared(config_.domain, config_.interface_address, config_.security);
    if (!participant) return std::unexpected(participant.error());
    auto commands = BytesReader::make(*participant, {topic_, kJointTrajectoryType, true, kCommandDepth},
                                      [&sink](const ReceivedSample& sample) { take_command(sample, sink); });
    if (!commands) return std::unexpected(commands.error());
    auto action = ActionServer::make(*participant, config_, sink);
    if (!action) return std::unexpected(action.error());
    std::unique_ptr<CountingWriter> states;
    if (config_.state_rate_hz > 0) {
      auto made = CountingWriter::make(*participant, fmt::format("rt/{}/controller_state", config_.name),
                                       kControllerStateType, kStateOptions);
      if (!made) return std::unexpected(made.error());
      states = std::move(*made);
    }
    const std::scoped_lock lock(mutex_);
    commands_ = std::move(*commands);
    action_ = std::move(*action);
    states_ = std::move(states);
    log_info("dds.controller", "{} takes trajectories: {}", config_.robot, endpoint());
    return {};
  }

  void close() override {
    const std::scoped_lock lock(mutex_);
    commands_.reset();
    action_.reset();
    states_.reset();
  }

  [[nodiscard]] TrajectoryEndpointStatus status() const override {
    TrajectoryEndpointStatus status;
    status.endpoint = endpoint();
    const std::scoped_lock lock(mutex_);
    if (!commands_) return status;
    status.publishers = commands_->matched_writers();
    status.messages = commands_->samples();
    if (states_) {
      status.state_readers = static_cast<int>(states_->readers());
      status.states = states_->sent();
    }
    status.clients = action_->clients();
    status.feedback = action_->feedback();
    status.bad_requests = action_->bad_requests();
    status.unanswered = action_->unanswered();
    return status;
  }

  void publish(const ControllerState& state) override {
    const std::scoped_lock lock(mutex_);
    if (!commands_ || state.reference.size() != names_.size() || state.feedback.size() != names_.size()) return;
    const ControllerMessage message{ros_time(to_wall_clock_ns(state.time)), names_, state};
    if (states_) {
      encode(message, config_.distribution, states_->payload());
      states_->write();
    }
    action_->publish_feedback(message);
  }

  // Open and close are calls of the same thread.
  void answer(const GoalId& goal, bool taken) override {
    if (action_) action_->answer(goal, taken);
  }
  void finish(const GoalId& goal, const GoalResult& result) override {
    if (action_) action_->finish(goal, result);
  }

 private:
  static void take_command(const ReceivedSample& sample, TrajectorySink& sink) {
    if (sample.received > sample.payload.size())
      return sink.refused(TrajectoryRefusal::too_many_points, fmt::format("a message of {} bytes, at most {} are taken",
                                                                          sample.received, kMaxPayloadBytes));
    JointTrajectory trajectory;
    const CdrFault fault = decode(sample.payload, trajectory);
    if (fault == CdrFault::none) return sink.command(std::move(trajectory));
    sink.refused(fault == CdrFault::too_many ? TrajectoryRefusal::too_many_points : TrajectoryRefusal::malformed,
                 std::string(words(fault)));
  }

  [[nodiscard]] std::string endpoint() const {
    return fmt::format("domain {} topic {} on {}", config_.domain, topic_, config_.interface_address);
  }

  const ControllerConfig config_;
  const std::string topic_;
  std::vector<std::string> names_;
  // Among open(), close(), publish() and status(). Threads of the library never take it.
  mutable std::mutex mutex_;
  std::unique_ptr<BytesReader> commands_;
  std::unique_ptr<ActionServer> action_;
  std::unique_ptr<CountingWriter> states_;  // null: not published
};

}  // namespace

Result<std::unique_ptr<TrajectoryEndpoint>> make_trajectory_endpoint(const ControllerConfig& config) {
  if (auto ok = check_domain(config.domain); !ok) return std::unexpected(ok.error());
  if (auto ok = check_topic(config.name); !ok) return std::unexpected(ok.error());
  return std::make_unique<DdsTrajectoryEndpoint>(config);
}

}  // namespace cellmirror::dds
