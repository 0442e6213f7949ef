// The server of FollowJointTrajectory as ROS 2 maps actions on DDS: three services, each a topic of requests and one of
// replies (rq/...Request, rr/...Reply; service_mapping.hpp), and the topics of feedback and status.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/dds/goal_book.hpp"
#include "drivers/dds/held_replies.hpp"
#include "drivers/dds/internal/bytes_reader.hpp"
#include "drivers/dds/internal/bytes_writer.hpp"
#include "drivers/dds/internal/participant.hpp"
#include "drivers/dds/service_mapping.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/controller_config.hpp"
#include "rt_core/ports/trajectory_endpoint.hpp"

namespace cellmirror::dds {

// Any thread.
class ActionServer {
 public:
  // `sink` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<ActionServer>> make(const std::shared_ptr<Participant>& participant,
                                                                  const ControllerConfig& config, TrajectorySink& sink);
  ~ActionServer();
  ActionServer(const ActionServer&) = delete;
  ActionServer& operator=(const ActionServer&) = delete;

  void answer(const GoalId& goal, bool taken);
  void finish(const GoalId& goal, const GoalResult& result);
  // To those that hear, while a goal runs.
  void publish_feedback(const ControllerMessage& message);

  [[nodiscard]] int clients() const;
  [[nodiscard]] std::uint64_t feedback() const { return feedback_sent_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t bad_requests() const { return bad_requests_.load(std::memory_order_relaxed); }
  // Replies that were dropped, since the client has no reader of them.
  [[nodiscard]] std::uint64_t unanswered() const { return unanswered_.load(std::memory_order_relaxed); }

 private:
  // A service's side of the server.
  struct Service {
    std::mutex mutex;  // of the next three
    HeldReplies held;
    std::vector<Guid> readers;  // of replies, matched
    std::unique_ptr<BytesWriter> replies;
    std::unique_ptr<BytesReader> requests;
  };
  ActionServer(std::shared_ptr<Participant> participant, TrajectorySink& sink, RosDistribution distribution)
      : participant_(std::move(participant)), sink_(sink), distribution_(distribution) {}
  Result<void> open(Service& service, const std::shared_ptr<Participant>& participant, const std::string& topic,
                    std::string_view request_type, std::string_view reply_type, BytesReader::Receive receive);
  [[nodiscard]] std::optional<ServiceRequest> open(const ReceivedSample& sample) const;
  void take_goal(const ReceivedSample& sample);
  void take_cancel(const ReceivedSample& sample);
  void take_result(const ReceivedSample& sample);
  void note_bad();
  void refuse(CdrFault fault);  // a goal
  void publish_status();
  template <class Encode>
  void reply(Service& service, const RequestName& to, const Encode& encode);
  static void send(Service& service, const RequestName& to);
  void note_reader(Service& service, const Guid& reader, bool matched);

  const std::shared_ptr<Participant> participant_;
  TrajectorySink& sink_;
  const RosDistribution distribution_;
  std::mutex mutex_;  // of the book; nothing is sent while it is held
  GoalBook book_;
  std::mutex status_mutex_;
  std::unique_ptr<BytesWriter> status_;
  std::unique_ptr<BytesWriter> feedback_;  // the publisher's thread
  std::atomic<std::uint64_t> feedback_sent_{0};
  std::atomic<std::uint64_t> bad_requests_{0};
  std::atomic<std::uint64_t> unanswered_{0};
  // Last: their readers call the above.
  Service goals_;
  Service cancels_;
  Service results_;
};

}  // namespace cellmirror::dds
