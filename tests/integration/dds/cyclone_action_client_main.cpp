// A client of the action control_msgs/FollowJointTrajectory as rmw_cyclonedds makes one: on Cyclone DDS, with types
// compiled from IDL by its own compiler. It shares no code with the gateway.
//   dds_cyclone_action_client DOMAIN NAME   reads from standard input, one a line, prints what comes as JSON, one a
//   line: goal ID JOINTS POINTS [path=X] [goal=X] [time=S]      POINTS: "T:P,P;T:P,P", T in s; tolerances of all joints
//   cancel ID | result ID
//   late ID    a client that asks for a result before it has a reader of replies: {"late": STATUS}
//   raw goal|cancel|result HEX    as a client that writes so: a number of bytes (4 bytes), and these
// Replies to others are counted: {"foreign": N}. One to a request that was answered already, or never made:
// "unexpected".
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cyclone_samples.hpp"
#include "follow_joint_trajectory.h"

namespace {

using cellmirror::dds::test::checked;
using cellmirror::dds::test::take_all;
using cellmirror::dds::test::view;

constexpr char kNetwork[] = R"(
<Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain>)";

void print(const std::string& line) {
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  std::puts(line.c_str());
  std::fflush(stdout);
}

std::string text(long long value) { return std::to_string(value); }

std::string text(const dds_sequence_double& values) {
  std::string out = "[";
  for (std::uint32_t i = 0; i < values._length; ++i) {
    char number[40];
    std::snprintf(number, sizeof number, "%s%.17g", i == 0 ? "" : ", ", values._buffer[i]);
    out += number;
  }
  return out + "]";
}

unique_identifier_msgs_msg_dds__UUID_ id_of(int number) {
  unique_identifier_msgs_msg_dds__UUID_ id;
  std::memset(id.uuid, 0x5A, sizeof id.uuid);
  id.uuid[0] = static_cast<std::uint8_t>(number);
  return id;
}

// What a service's readers and writers have: rmw_qos_profile_services_default, and the client's id.
class Endpoint {
 public:
  explicit Endpoint(dds_entity_t participant) : participant_(participant) {}

  dds_entity_t writer(const std::string& name, const dds_topic_descriptor_t& type, const std::string& user_data) const {
    dds_qos_t* qos = qos_of(user_data, false);
    const dds_entity_t made = dds_create_writer(participant_, topic(name, type), qos, nullptr);
    dds_delete_qos(qos);
    return checked(made, "Cyclone writer");
  }
  dds_entity_t reader(const std::string& name, const dds_topic_descriptor_t& type, const std::string& user_data,
                      bool transient = false) const {
    dds_qos_t* qos = qos_of(user_data, transient);
    const dds_entity_t made = dds_create_reader(participant_, topic(name, type), qos, nullptr);
    dds_delete_qos(qos);
    return checked(made, "Cyclone reader");
  }
  // As rmw_cyclonedds names a client: GUID of the participant, the last four bytes replaced by a number.
  std::string client_id() const {
    static std::uint32_t count = 0;
    dds_guid_t guid;
    checked(dds_get_guid(participant_, &guid), "Cyclone GUID");
    ++count;
    for (int i = 0; i < 4; ++i) guid.v[12 + i] = static_cast<std::uint8_t>(count >> (24 - 8 * i));
    std::string out = "clientid=";
    for (std::size_t i = 0; i < sizeof guid.v; ++i) {
      char byte[8];
      std::snprintf(byte, sizeof byte, i == 0 ? "%2x" : ".%x", static_cast<unsigned>(guid.v[i]));
      out += byte;
    }
    return out + ";";
  }

 private:
  static dds_qos_t* qos_of(const std::string& user_data, bool transient) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_writer_data_lifecycle(qos, false);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
    if (transient) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_userdata(qos, user_data.data(), user_data.size());
    return qos;
  }
  dds_entity_t topic(const std::string& name, const dds_topic_descriptor_t& type) const {
    return checked(dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr), "Cyclone topic");
  }

  dds_entity_t participant_;
};

// A service's client: replies are its own where they begin with its writer's handle.
template <class Request, class Reply>
class Service {
 public:
  using Use = std::function<void(const Reply&)>;

  Service(const Endpoint& endpoint, const std::string& name, const dds_topic_descriptor_t& request,
          const dds_topic_descriptor_t& reply, Use use)
      : use_(std::move(use)) {
    const std::string id = endpoint.client_id();
    writer_ = endpoint.writer("rq/" + name + "Request", request, id);
    reader_ = endpoint.reader("rr/" + name + "Reply", reply, id);
    checked(dds_get_instance_handle(writer_, &client_), "Cyclone handle");
  }
  void send(Request& request) {
    static std::atomic<std::int64_t> numbers{0};
    request.head = {client_, ++numbers};
    {
      const std::scoped_lock lock(mutex_);
      open_.insert(request.head.number);
    }
    dds_write(writer_, &request);
  }
  void take() {
    take_all<Reply>(reader_, [this](const Reply& reply) {
      if (reply.head.client != client_) return print("{\"foreign\": " + text(++foreign_) + "}");
      std::size_t known = 0;
      {
        const std::scoped_lock lock(mutex_);
        known = open_.erase(reply.head.number);
      }
      if (known == 0) return print("{\"unexpected\": " + text(reply.head.number) + "}");
      use_(reply);
    });
  }
  [[nodiscard]] bool matched() const {
    return dds_get_matched_subscriptions(writer_, nullptr, 0) > 0 &&
           dds_get_matched_publications(reader_, nullptr, 0) > 0;
  }

 private:
  Use use_;
  dds_entity_t writer_ = 0;
  dds_entity_t reader_ = 0;
  dds_instance_handle_t client_ = 0;
  std::mutex mutex_;
  std::set<std::int64_t> open_;
  long long foreign_ = 0;
};

std::vector<std::string> split(const std::string& from, char by) {
  std::vector<std::string> out;
  std::stringstream in(from);
  for (std::string one; std::getline(in, one, by);) out.push_back(one);
  return out;
}

template <class Time>
void set_time(double t, Time& time) {
  time.sec = static_cast<std::int32_t>(std::floor(t));
  time.nanosec = static_cast<std::uint32_t>(std::llround((t - std::floor(t)) * 1e9));
}

template <class Sequence, class Element>
void set_sequence(std::vector<Element>& from, Sequence& sequence) {
  const auto n = static_cast<std::uint32_t>(from.size());
  sequence = {n, n, from.data(), false};
}

using Goal = control_msgs_action_dds__FollowJointTrajectory_SendGoal_Request_;
using GoalReply = control_msgs_action_dds__FollowJointTrajectory_SendGoal_Response_;
using ResultRequest = control_msgs_action_dds__FollowJointTrajectory_GetResult_Request_;
using ResultReply = control_msgs_action_dds__FollowJointTrajectory_GetResult_Response_;
using Cancel = action_msgs_srv_dds__CancelGoal_Request_;
using CancelReply = action_msgs_srv_dds__CancelGoal_Response_;
const dds_topic_descriptor_t& kResultRequest = control_msgs_action_dds__FollowJointTrajectory_GetResult_Request__desc;
const dds_topic_descriptor_t& kResultReply = control_msgs_action_dds__FollowJointTrajectory_GetResult_Response__desc;
using Feedback = control_msgs_action_dds__FollowJointTrajectory_FeedbackMessage_;
using Status = action_msgs_msg_dds__GoalStatusArray_;

void send_goal(std::istream& line, Service<Goal, GoalReply>& goals) {
  int number = 0;
  std::string joints;
  std::string points;
  line >> number >> joints >> points;
  double path = 0;
  double end = 0;
  double time = 0;
  for (std::string word; line >> word;) {
    const double value = std::strtod(word.c_str() + word.find('=') + 1, nullptr);
    if (word.starts_with("path=")) path = value;
    if (word.starts_with("goal=")) end = value;
    if (word.starts_with("time=")) time = value;
  }
  std::vector<std::string> words = split(joints, ',');
  std::vector<char*> names;
  std::vector<control_msgs_msg_dds__JointTolerance_> on_path;
  std::vector<control_msgs_msg_dds__JointTolerance_> at_end;
  for (std::string& word : words) {
    names.push_back(word.data());
    if (path != 0) on_path.push_back({word.data(), path, 0, 0});
    if (end != 0) at_end.push_back({word.data(), end, 0, 0});
  }
  std::vector<std::vector<double>> positions;
  std::vector<trajectory_msgs_msg_dds__JointTrajectoryPoint_> all;
  for (const std::string& one : split(points, ';')) {
    const auto parts = split(one, ':');
    auto& values = positions.emplace_back();
    for (const auto& value : split(parts.at(1), ',')) values.push_back(std::strtod(value.c_str(), nullptr));
    set_time(std::strtod(parts.at(0).c_str(), nullptr), all.emplace_back().time_from_start);
    all.back().positions = view(values);
  }
  char nothing[] = "";
  Goal goal{};
  goal.goal_id = id_of(number);
  goal.trajectory.header.frame_id = nothing;
  goal.multi_dof_trajectory.header.frame_id = nothing;
  set_sequence(names, goal.trajectory.joint_names);
  set_sequence(all, goal.trajectory.points);
  set_sequence(on_path, goal.path_tolerance);
  set_sequence(at_end, goal.goal_tolerance);
  set_time(time, goal.goal_time_tolerance);
  goals.send(goal);
}

void print_feedback(const Feedback& feedback) {
  print("{\"feedback\": " + text(feedback.goal_id.uuid[0]) + ", \"desired\": " + text(feedback.desired.positions) +
        ", \"actual\": " + text(feedback.actual.positions) + "}");
}

void print_status(const Status& status) {
  std::string line = "{\"status\": {";
  for (std::uint32_t i = 0; i < status.status_list._length; ++i) {
    const auto& one = status.status_list._buffer[i];
    line += (i == 0 ? "\"" : ", \"") + text(one.goal_info.goal_id.uuid[0]) + "\": " + text(one.status);
  }
  print(line + "}}");
}

// Writes bytes under the name of a service's request. A participant of its own: within one a topic has one type.
void send_raw(int domain, const std::string& name, const char* type, const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::strtoul(hex.substr(i, 2).c_str(), nullptr, 16)));
  dds_topic_descriptor_t described = raw_Bytes__desc;
  described.m_typename = type;
  const Endpoint endpoint(
      checked(dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr), "Cyclone participant"));
  const dds_entity_t writer = endpoint.writer("rq/" + name + "Request", described, endpoint.client_id());
  while (dds_get_matched_subscriptions(writer, nullptr, 0) <= 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  raw_Bytes_ sample{};
  set_sequence(bytes, sample.bytes);
  dds_write(writer, &sample);  // the participant stays until the end, so that it arrives
}

// Asks before it has a reader of replies.
void ask_early(const Endpoint& endpoint, const std::string& service, int number) {
  const std::string id = endpoint.client_id();
  const dds_entity_t writer = endpoint.writer("rq/" + service + "Request", kResultRequest, id);
  while (dds_get_matched_subscriptions(writer, nullptr, 0) <= 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ResultRequest request{};
  dds_instance_handle_t client = 0;
  checked(dds_get_instance_handle(writer, &client), "Cyclone handle");
  request.head = {client, 1};
  request.goal_id = id_of(number);
  dds_write(writer, &request);
  checked(dds_wait_for_acks(writer, DDS_SECS(60)), "Cyclone acknowledgment");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // so that the server has answered by then
  const dds_entity_t reader = endpoint.reader("rr/" + service + "Reply", kResultReply, id);
  for (bool heard = false; !heard; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    take_all<ResultReply>(reader, [&](const ResultReply& reply) {
      if (reply.head.client != client || reply.head.number != 1) return;
      heard = true;
      print("{\"late\": " + text(reply.status) + "}");
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const int domain = std::atoi(argv[1]);
  const auto domain_id = static_cast<dds_domainid_t>(domain);
  checked(dds_create_domain(domain_id, kNetwork), "Cyclone domain");
  const Endpoint endpoint(checked(dds_create_participant(domain_id, nullptr, nullptr), "Cyclone participant"));
  const std::string action = std::string(argv[2]) + "/follow_joint_trajectory/_action/";
  const dds_entity_t feedback = endpoint.reader(
      "rt/" + action + "feedback", control_msgs_action_dds__FollowJointTrajectory_FeedbackMessage__desc, "");
  const dds_entity_t status =
      endpoint.reader("rt/" + action + "status", action_msgs_msg_dds__GoalStatusArray__desc, "", true);
  Service<Goal, GoalReply> goals(
      endpoint, action + "send_goal", control_msgs_action_dds__FollowJointTrajectory_SendGoal_Request__desc,
      control_msgs_action_dds__FollowJointTrajectory_SendGoal_Response__desc,
      [](const GoalReply& reply) { print(std::string("{\"accepted\": ") + (reply.accepted ? "true}" : "false}")); });
  Service<Cancel, CancelReply> cancels(
      endpoint, action + "cancel_goal", action_msgs_srv_dds__CancelGoal_Request__desc,
      action_msgs_srv_dds__CancelGoal_Response__desc, [](const CancelReply& reply) {
        print("{\"cancel\": " + text(reply.return_code) + ", \"goals\": " + text(reply.goals_canceling._length) + "}");
      });
  Service<ResultRequest, ResultReply> results(
      endpoint, action + "get_result", kResultRequest, kResultReply, [](const ResultReply& reply) {
        print("{\"result\": " + text(reply.status) + ", \"error_code\": " + text(reply.error_code) + ", \"text\": \"" +
              reply.error_string + "\"}");
      });
  std::thread([&] {
    for (;;) {
      goals.take();
      cancels.take();
      results.take();
      take_all<Feedback>(feedback, print_feedback);
      take_all<Status>(status, print_status);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }).detach();
  while (!goals.matched() || !cancels.matched() || !results.matched())
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  print("{\"ready\": true}");
  for (std::string line_text; std::getline(std::cin, line_text);) {
    std::istringstream line(line_text);
    std::string verb;
    line >> verb;
    if (verb == "goal") {
      send_goal(line, goals);
    } else if (verb == "raw") {
      std::string service;
      std::string hex;
      line >> service >> hex;
      if (service == "goal")
        send_raw(domain, action + "send_goal", "control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Request_",
                 hex);
      if (service == "cancel")
        send_raw(domain, action + "cancel_goal", "action_msgs::srv::dds_::CancelGoal_Request_", hex);
      if (service == "result")
        send_raw(domain, action + "get_result", "control_msgs::action::dds_::FollowJointTrajectory_GetResult_Request_",
                 hex);
    } else {
      int number = 0;
      line >> number;
      if (verb == "result") {
        ResultRequest request{};
        request.goal_id = id_of(number);
        results.send(request);
      }
      if (verb == "late") ask_early(endpoint, action + "get_result", number);
      if (verb == "cancel") {
        Cancel request{};
        request.goal_info.goal_id = id_of(number);
        cancels.send(request);
      }
    }
  }
  std::fflush(stdout);
  std::_Exit(0);
}
