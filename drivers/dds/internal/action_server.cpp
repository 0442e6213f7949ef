#include "drivers/dds/internal/action_server.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "drivers/dds/internal/service_clients.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

namespace {

constexpr int kServiceDepth = 10;  // as rmw_qos_profile_services_default has it

RosTime wall_time_now() { return ros_time(to_wall_clock_ns(SystemClock().now())); }

bool too_long(const ReceivedSample& sample) { return sample.received > sample.payload.size(); }

}  // namespace

Result<std::unique_ptr<ActionServer>> ActionServer::make(const std::shared_ptr<Participant>& participant,
                                                         const ControllerConfig& config, TrajectorySink& sink) {
  std::unique_ptr<ActionServer> made(new ActionServer(participant, sink, config.distribution));
  ActionServer* const self = made.get();
  const std::string action = config.name + "/follow_joint_trajectory/_action/";
  auto status = BytesWriter::make(participant, {"rt/" + action + "status", kGoalStatusType, true, 1, false, true});
  if (!status) return std::unexpected(status.error());
  made->status_ = std::move(*status);
  auto feedback = BytesWriter::make(participant, {"rt/" + action + "feedback", kFeedbackType, true, kServiceDepth});
  if (!feedback) return std::unexpected(feedback.error());
  made->feedback_ = std::move(*feedback);
  if (auto opened = made->open(made->goals_, participant, action + "send_goal", kSendGoalRequestType,
                               kSendGoalReplyType, [self](const ReceivedSample& sample) { self->take_goal(sample); });
      !opened)
    return std::unexpected(opened.error());
  if (auto opened = made->open(made->cancels_, participant, action + "cancel_goal", kCancelRequestType,
                               kCancelReplyType, [self](const ReceivedSample& sample) { self->take_cancel(sample); });
      !opened)
    return std::unexpected(opened.error());
  if (auto opened =
          made->open(made->results_, participant, action + "get_result", kGetResultRequestType, kGetResultReplyType,
                     [self](const ReceivedSample& sample) { self->take_result(sample); });
      !opened)
    return std::unexpected(opened.error());
  return made;
}

ActionServer::~ActionServer() {
  // Those that call first, while what they call is there.
  for (Service* service : {&goals_, &cancels_, &results_}) {
    service->requests.reset();
    if (service->replies) service->replies->on_reader({});
  }
}

Result<void> ActionServer::open(Service& service, const std::shared_ptr<Participant>& participant,
                                const std::string& topic, std::string_view request_type, std::string_view reply_type,
                                BytesReader::Receive receive) {
  auto replies = BytesWriter::make(participant, {"rr/" + topic + "Reply", reply_type, true, kServiceDepth});
  if (!replies) return std::unexpected(replies.error());
  service.replies = std::move(*replies);
  service.replies->on_reader(
      [this, &service](const Guid& reader, bool matched) { note_reader(service, reader, matched); });
  auto requests = BytesReader::make(participant, {"rq/" + topic + "Request", request_type, true, kServiceDepth},
                                    std::move(receive));
  if (!requests) return std::unexpected(requests.error());
  service.requests = std::move(*requests);
  return {};
}

template <class Encode>
void ActionServer::reply(Service& service, const RequestName& to, const Encode& encode) {
  const std::scoped_lock lock(service.mutex);
  CdrWriter out(service.replies->payload());
  begin_reply(to, out);
  encode(out);
  end_reply(out);
  if (participant_->clients().reaches(to, service.readers)) return send(service, to);
  if (!service.held.hold(to, service.replies->payload())) unanswered_.fetch_add(1, std::memory_order_relaxed);
}

// Under the service's mutex.
void ActionServer::send(Service& service, const RequestName& to) {
  if (!service.replies->write_reply(to.sample)) log_warning("dds.action", "an answer could not be sent");
}

void ActionServer::note_reader(Service& service, const Guid& reader, bool matched) {
  const std::scoped_lock lock(service.mutex);
  std::erase(service.readers, reader);
  if (!matched) return;
  service.readers.push_back(reader);
  if (participant_->clients().contains(reader)) {
    write_reply_to_nobody(service.replies->payload());
    send(service, {});
  }
  const auto reaches = [&](const RequestName& to) { return participant_->clients().reaches(to, service.readers); };
  for (HeldReply& reply : service.held.take(reaches)) {
    service.replies->payload().swap(reply.payload);
    send(service, reply.to);
  }
}

void ActionServer::note_bad() { bad_requests_.fetch_add(1, std::memory_order_relaxed); }

std::optional<ServiceRequest> ActionServer::open(const ReceivedSample& sample) const {
  return open_request({.payload = too_long(sample) ? sample.start : sample.payload,
                       .name = sample.name,
                       .related = sample.related_guid,
                       .announces_client = participant_->clients().contains(sample.name.guid)});
}

void ActionServer::refuse(CdrFault fault) {
  note_bad();
  sink_.refused(fault == CdrFault::too_many ? TrajectoryRefusal::too_many_points : TrajectoryRefusal::malformed,
                fmt::format("a goal: {}", words(fault)));
}

void ActionServer::take_goal(const ReceivedSample& sample) {
  const auto opened = open(sample);
  if (!opened) return refuse(CdrFault::truncated);
  GoalRequest request;
  const CdrFault fault = too_long(sample) ? CdrFault::too_many : decode(opened->content, request);
  bool asked = false;
  if (fault == CdrFault::none) {
    const std::scoped_lock lock(mutex_);
    asked = book_.ask(request.goal.id, opened->name, wall_time_now());
  } else {
    refuse(fault);
  }
  if (asked) return sink_.goal(std::move(request.goal), std::move(request.trajectory));
  reply(goals_, opened->name, [](CdrWriter& out) { write_goal_reply(false, wall_time_now(), out); });
}

void ActionServer::take_cancel(const ReceivedSample& sample) {
  const auto opened = open(sample);
  CancelRequest request;
  if (!opened || decode(opened->content, request) != CdrFault::none) return note_bad();
  GoalBook::Cancel cancel;
  {
    const std::scoped_lock lock(mutex_);
    cancel = book_.cancel(request);
  }
  reply(cancels_, opened->name, [&](CdrWriter& out) { write_cancel_reply(cancel.code, cancel.goals, out); });
  if (cancel.goals.empty()) return;
  publish_status();
  for (const GoalInfo& goal : cancel.goals) sink_.cancel(goal.id);
}

void ActionServer::take_result(const ReceivedSample& sample) {
  const auto opened = open(sample);
  GoalId id{};
  if (!opened || decode(opened->content, id) != CdrFault::none) return note_bad();
  std::optional<GoalBook::Reply> now;
  {
    const std::scoped_lock lock(mutex_);
    now = book_.result_of(id, opened->name);
  }
  if (now) reply(results_, opened->name, [&](CdrWriter& out) { write_result_reply(now->status, now->result, out); });
}

void ActionServer::publish_status() {
  const std::scoped_lock lock(status_mutex_);
  std::vector<GoalInfo> goals;
  {
    const std::scoped_lock of_book(mutex_);
    goals = book_.status();
  }
  encode_status(goals, status_->payload());
  status_->write();
}

void ActionServer::answer(const GoalId& goal, bool taken) {
  std::optional<RequestName> to;
  {
    const std::scoped_lock lock(mutex_);
    to = book_.answer(goal, taken);
  }
  if (!to) return;
  reply(goals_, *to, [taken](CdrWriter& out) { write_goal_reply(taken, wall_time_now(), out); });
  if (taken) publish_status();
}

void ActionServer::finish(const GoalId& goal, const GoalResult& result) {
  std::optional<GoalBook::Finished> finished;
  {
    const std::scoped_lock lock(mutex_);
    finished = book_.finish(goal, result);
  }
  if (!finished) return;
  for (const RequestName& to : finished->waiting)
    reply(results_, to,
          [&](CdrWriter& out) { write_result_reply(finished->reply.status, finished->reply.result, out); });
  publish_status();
}

void ActionServer::publish_feedback(const ControllerMessage& message) {
  if (feedback_->matched_readers() == 0) return;
  std::optional<GoalId> goal;
  {
    const std::scoped_lock lock(mutex_);
    goal = book_.running();
  }
  if (!goal) return;
  encode_feedback(*goal, message, distribution_, feedback_->payload());
  if (feedback_->write()) feedback_sent_.fetch_add(1, std::memory_order_relaxed);
}

int ActionServer::clients() const { return std::max(goals_.requests->matched_writers(), 0); }

}  // namespace cellmirror::dds
