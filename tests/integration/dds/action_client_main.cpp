// A client of the action control_msgs/FollowJointTrajectory as rmw_fastrtps makes one, on Fast DDS and with a CDR of
// its own, written from the public IDL: it shares no code with the gateway.
//   dds_action_client DOMAIN NAME        reads from standard input, one a line, prints what comes as JSON, one a line:
//   goal ID JOINTS POINTS [path=X] [goal=X] [time=S]      POINTS: "T:P,P;T:P,P", T in s; tolerances of all joints
//   cancel ID | result ID
#include <fastdds/rtps/common/WriteParams.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fd = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Bytes = std::vector<std::uint8_t>;

class BytesSupport final : public fd::TopicDataType {
 public:
  explicit BytesSupport(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 4096;
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<Bytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

// Little endian CDR behind its header of four bytes.
struct Out {
  Bytes bytes{0, 1, 0, 0};
  void align(std::size_t n) {
    while ((bytes.size() - 4) % n != 0) bytes.push_back(0);
  }
  template <class T>
  void put(T value) {
    align(sizeof(T));
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.insert(bytes.end(), raw, raw + sizeof(T));
  }
  void text(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    bytes.insert(bytes.end(), value.begin(), value.end());
    bytes.push_back(0);
  }
  void doubles(const std::vector<double>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    for (const double value : values) put(value);
  }
  void id(int number) {
    for (int i = 0; i < 16; ++i) bytes.push_back(i == 0 ? static_cast<std::uint8_t>(number) : std::uint8_t{0x5A});
  }
};

struct In {
  const Bytes& bytes;
  std::size_t at = 4;
  template <class T>
  T get() {
    while ((at - 4) % sizeof(T) != 0) ++at;
    T value{};
    if (at + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof(T));
    at += sizeof(T);
    return value;
  }
  std::string text() {
    const auto size = get<std::uint32_t>();
    std::string out;
    if (size > 0 && at + size <= bytes.size()) out.assign(reinterpret_cast<const char*>(bytes.data()) + at, size - 1);
    at += size;
    return out;
  }
  std::string doubles() {
    std::string out = "[";
    const auto count = get<std::uint32_t>();
    for (std::uint32_t i = 0; i < count && at < bytes.size(); ++i) {
      char number[40];
      std::snprintf(number, sizeof number, "%s%.17g", i == 0 ? "" : ", ", get<double>());
      out += number;
    }
    return out + "]";
  }
  int id() {
    const int number = at < bytes.size() ? bytes[at] : -1;
    at += 16;
    return number;
  }
  // trajectory_msgs/JointTrajectoryPoint: its positions.
  std::string point() {
    const std::string positions = doubles();
    for (int i = 0; i < 3; ++i) doubles();
    get<std::int32_t>();
    get<std::uint32_t>();
    return positions;
  }
};

std::mutex output;
void print(const std::string& line) {
  const std::scoped_lock lock(output);
  std::puts(line.c_str());
  std::fflush(stdout);
}

class Reader final : public fd::DataReaderListener {
 public:
  using Take = std::function<void(const Bytes&, const fd::SampleInfo&)>;
  explicit Reader(Take take) : take_(std::move(take)) {}
  void on_data_available(fd::DataReader* reader) override {
    Bytes bytes;
    fd::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) take_(bytes, info);
    }
  }

 private:
  Take take_;
};

struct Client {
  fd::DomainParticipant* participant = nullptr;
  fd::Publisher* publisher = nullptr;
  fd::Subscriber* subscriber = nullptr;
  std::vector<std::unique_ptr<Reader>> listeners;

  explicit Client(int domain) {
    fd::DomainParticipantQos qos;
    qos.transport().use_builtin_transports = false;
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.emplace_back("127.0.0.1");
    udp->maxInitialPeersRange = 20;
    qos.transport().user_transports.push_back(udp);
    rtps::Locator_t peer;
    peer.kind = LOCATOR_KIND_UDPv4;
    rtps::IPLocator::setIPv4(peer, "127.0.0.1");
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    qos.wire_protocol().builtin.discovery_config.leaseDuration_announcementperiod = {1, 0};
    participant =
        fd::DomainParticipantFactory::get_instance()->create_participant(static_cast<std::uint32_t>(domain), qos);
    publisher = participant->create_publisher(fd::PUBLISHER_QOS_DEFAULT);
    subscriber = participant->create_subscriber(fd::SUBSCRIBER_QOS_DEFAULT);
  }
  fd::Topic* topic(const std::string& name, const std::string& type) {
    fd::TypeSupport support(new BytesSupport(type));
    support.register_type(participant);
    return participant->create_topic(name, type, fd::TOPIC_QOS_DEFAULT);
  }
  fd::DataWriter* writer(const std::string& name, const std::string& type) {
    fd::DataWriterQos qos;
    qos.reliability().kind = fd::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.data_sharing().off();
    return publisher->create_datawriter(topic(name, type), qos);
  }
  fd::DataReader* reader(const std::string& name, const std::string& type, bool transient, Reader::Take take) {
    fd::DataReaderQos qos;
    qos.reliability().kind = fd::RELIABLE_RELIABILITY_QOS;
    if (transient) qos.durability().kind = fd::TRANSIENT_LOCAL_DURABILITY_QOS;
    qos.history().depth = 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.data_sharing().off();
    listeners.push_back(std::make_unique<Reader>(std::move(take)));
    return subscriber->create_datareader(topic(name, type), qos, listeners.back().get());
  }
};

// A service's client: replies are its own where they name its reader.
struct Service {
  fd::DataReader* replies = nullptr;
  fd::DataWriter* requests = nullptr;

  Service(Client& client, const std::string& name, const std::string& type, std::function<void(In&)> take) {
    const auto own = std::make_shared<rtps::GUID_t>();
    replies = client.reader("rr/" + name + "Reply", type + "_Response_", false,
                            [own, take = std::move(take)](const Bytes& bytes, const fd::SampleInfo& info) {
                              if (info.related_sample_identity.writer_guid() != *own) return;
                              In in{bytes};
                              take(in);
                            });
    *own = replies->guid();
    requests = client.writer("rq/" + name + "Request", type + "_Request_");
  }
  void send(Bytes bytes) {
    rtps::WriteParams parameters;
    parameters.related_sample_identity().writer_guid() = replies->guid();
    requests->write(&bytes, parameters);
  }
  [[nodiscard]] bool matched() const {
    fd::PublicationMatchedStatus to;
    fd::SubscriptionMatchedStatus from;
    requests->get_publication_matched_status(to);
    replies->get_subscription_matched_status(from);
    return to.current_count > 0 && from.current_count > 0;
  }
};

std::vector<std::string> split(const std::string& text, char by) {
  std::vector<std::string> out;
  std::stringstream in(text);
  for (std::string one; std::getline(in, one, by);) out.push_back(one);
  return out;
}

// FollowJointTrajectory_SendGoal_Request.
Bytes goal_of(std::istream& line) {
  int number = 0;
  std::string joints;
  std::string points;
  line >> number >> joints >> points;
  double path = 0;
  double goal = 0;
  double time = 0;
  for (std::string word; line >> word;) {
    const double value = std::strtod(word.c_str() + word.find('=') + 1, nullptr);
    if (word.starts_with("path=")) path = value;
    if (word.starts_with("goal=")) goal = value;
    if (word.starts_with("time=")) time = value;
  }
  const auto names = split(joints, ',');
  Out out;
  out.id(number);
  out.put(std::int32_t{0});
  out.put(std::uint32_t{0});
  out.text("");
  out.put(static_cast<std::uint32_t>(names.size()));
  for (const auto& name : names) out.text(name);
  const auto all = split(points, ';');
  out.put(static_cast<std::uint32_t>(all.size()));
  for (const auto& one : all) {
    const auto parts = split(one, ':');
    std::vector<double> positions;
    for (const auto& value : split(parts.at(1), ',')) positions.push_back(std::strtod(value.c_str(), nullptr));
    out.doubles(positions);
    for (int i = 0; i < 3; ++i) out.put(std::uint32_t{0});
    const double t = std::strtod(parts.at(0).c_str(), nullptr);
    out.put(static_cast<std::int32_t>(std::floor(t)));
    out.put(static_cast<std::uint32_t>(std::llround((t - std::floor(t)) * 1e9)));
  }
  out.put(std::int32_t{0});  // MultiDOFJointTrajectory: header, no joints, no points
  out.put(std::uint32_t{0});
  out.text("");
  out.put(std::uint32_t{0});
  out.put(std::uint32_t{0});
  for (const double tolerance : {path, goal}) {
    out.put(static_cast<std::uint32_t>(tolerance == 0 ? 0 : names.size()));
    for (std::size_t i = 0; tolerance != 0 && i < names.size(); ++i) {
      out.text(names[i]);
      out.put(tolerance);
      out.put(0.0);
      out.put(0.0);
    }
    out.put(std::uint32_t{0});  // component tolerances
  }
  out.put(static_cast<std::int32_t>(std::floor(time)));
  out.put(static_cast<std::uint32_t>(std::llround((time - std::floor(time)) * 1e9)));
  return out.bytes;
}

std::string number_text(long long value) { return std::to_string(value); }

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  Client client(std::atoi(argv[1]));
  const std::string action = std::string(argv[2]) + "/follow_joint_trajectory/_action/";
  const std::string type = "control_msgs::action::dds_::FollowJointTrajectory_";
  Service goals(client, action + "send_goal", type + "SendGoal", [](In& in) {
    print(std::string("{\"accepted\": ") + (in.get<std::uint8_t>() != 0 ? "true}" : "false}"));
  });
  Service cancels(client, action + "cancel_goal", "action_msgs::srv::dds_::CancelGoal", [](In& in) {
    const int code = in.get<std::int8_t>();
    print("{\"cancel\": " + number_text(code) + ", \"goals\": " + number_text(in.get<std::uint32_t>()) + "}");
  });
  Service results(client, action + "get_result", type + "GetResult", [](In& in) {
    const int status = in.get<std::int8_t>();
    const auto code = in.get<std::int32_t>();
    print("{\"result\": " + number_text(status) + ", \"error_code\": " + number_text(code) + ", \"text\": \"" +
          in.text() + "\"}");
  });
  client.reader(
      "rt/" + action + "feedback", type + "FeedbackMessage_", false, [](const Bytes& bytes, const fd::SampleInfo&) {
        In in{bytes};
        const int id = in.id();
        in.get<std::int32_t>();
        in.get<std::uint32_t>();
        in.text();
        const auto joints = in.get<std::uint32_t>();
        for (std::uint32_t i = 0; i < joints; ++i) in.text();
        const std::string desired = in.point();
        const std::string actual = in.point();
        print("{\"feedback\": " + number_text(id) + ", \"desired\": " + desired + ", \"actual\": " + actual + "}");
      });
  client.reader("rt/" + action + "status", "action_msgs::msg::dds_::GoalStatusArray_", true,
                [](const Bytes& bytes, const fd::SampleInfo&) {
                  In in{bytes};
                  const auto count = in.get<std::uint32_t>();
                  std::string line = "{\"status\": {";
                  for (std::uint32_t i = 0; i < count; ++i) {
                    const int id = in.id();
                    in.get<std::int32_t>();
                    in.get<std::uint32_t>();
                    line += (i == 0 ? "\"" : ", \"") + number_text(id) + "\": " + number_text(in.get<std::int8_t>());
                  }
                  print(line + "}}");
                });
  while (!goals.matched() || !cancels.matched() || !results.matched())
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  print("{\"ready\": true}");
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream line(text);
    std::string verb;
    line >> verb;
    if (verb == "goal") {
      goals.send(goal_of(line));
      continue;
    }
    int number = 0;
    line >> number;
    Out out;
    out.id(number);
    if (verb == "result") results.send(out.bytes);
    if (verb != "cancel") continue;
    out.put(std::int32_t{0});
    out.put(std::uint32_t{0});
    cancels.send(out.bytes);
  }
  // The library's threads end with the process.
  std::fflush(stdout);
  std::_Exit(0);
}
