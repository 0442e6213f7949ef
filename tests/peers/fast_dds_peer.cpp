// A node as rmw_fastrtps makes one, on any Fast DDS from 2.9 to 3.x: its default transports and discovery, messages in
// plain CDR (version 1), no type object. It shares no code with the gateway. fast_dds.py builds and runs it.
//   fast_dds_peer version     prints the version of the library
//   fast_dds_peer talker      publishes sensor_msgs/JointState on rt/joint_states every 10 ms, J_1 at STEP_RAD times
//   the
//                             number of the message, and reads rt/cellmirror/joint_states and rt/cellmirror/summary
//   fast_dds_peer passer-by   has the same readers and a writer of another topic; of its samples it prints nothing
// Until SIGTERM. One line of JSON for each event; at_s is CLOCK_MONOTONIC, took_s how long a call of the library
// lasted:
//   {"event": "started" | "made" | "matched" | "unmatched" | "written" | "joints" | "summary", "at_s", "topic",
//   "took_s", "position"}
#if __has_include(<fastdds/config.hpp>)
#include <fastdds/config.hpp>
#define FAST_DDS_3 1
#define VERSION_TEXT FASTDDS_VERSION_STR
#else
#include <fastrtps/config.h>
#define FAST_DDS_3 0
#define VERSION_TEXT FASTRTPS_VERSION_STR
#endif

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace {

namespace fd = eprosima::fastdds::dds;
#if FAST_DDS_3
namespace rtps = eprosima::fastdds::rtps;
const auto kOk = fd::RETCODE_OK;
#else
namespace rtps = eprosima::fastrtps::rtps;
const auto kOk = eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;
#endif
using Bytes = std::vector<std::uint8_t>;

constexpr double kStepRad = 1e-4;
constexpr long kPeriodNs = 10'000'000;
constexpr std::uint32_t kLargestMessage = 65536;
constexpr char kJointState[] = "sensor_msgs::msg::dds_::JointState_";
constexpr char kString[] = "std_msgs::msg::dds_::String_";

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::mutex output;
bool only_passing = false;
void print(const char* event, const std::string& topic, const std::string& more = "") {
  const std::lock_guard<std::mutex> lock(output);
  std::printf("{\"event\": \"%s\", \"at_s\": %.6f, \"topic\": \"%s\"%s}\n", event, now_s(), topic.c_str(),
              more.c_str());
  std::fflush(stdout);
}
std::string member(const char* name, double value) {
  char text[64];
  std::snprintf(text, sizeof text, ", \"%s\": %.9g", name, value);
  return text;
}

// A message whose bytes are its CDR, header included.
class BytesType final : public fd::TopicDataType {
 public:
  explicit BytesType(const std::string& name) {
#if FAST_DDS_3
    set_name(name);
    max_serialized_type_size = kLargestMessage;
    is_compute_key_provided = false;
#else
    setName(name.c_str());
    m_typeSize = kLargestMessage;
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
#endif
  }

#if FAST_DDS_3
  bool serialize(const void* data, rtps::SerializedPayload_t& payload, fd::DataRepresentationId_t) override {
    return put(*static_cast<const Bytes*>(data), payload);
  }
  bool deserialize(rtps::SerializedPayload_t& payload, void* data) override { return get(payload, data); }
  std::uint32_t calculate_serialized_size(const void* data, fd::DataRepresentationId_t) override { return size(data); }
  void* create_data() override { return new Bytes; }
  void delete_data(void* data) override { delete static_cast<Bytes*>(data); }
  bool compute_key(rtps::SerializedPayload_t&, rtps::InstanceHandle_t&, bool) override { return false; }
  bool compute_key(const void*, rtps::InstanceHandle_t&, bool) override { return false; }
#else
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    return put(*static_cast<const Bytes*>(data), *payload);
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override { return get(*payload, data); }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return size(data); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
#endif

 private:
  static std::uint32_t size(const void* data) {
    return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size());
  }
  static bool put(const Bytes& bytes, rtps::SerializedPayload_t& payload) {
    if (bytes.size() > payload.max_size) return false;
    std::memcpy(payload.data, bytes.data(), bytes.size());
    payload.length = static_cast<std::uint32_t>(bytes.size());
    payload.encapsulation = CDR_LE;
    return true;
  }
  static bool get(const rtps::SerializedPayload_t& payload, void* data) {
    static_cast<Bytes*>(data)->assign(payload.data, payload.data + payload.length);
    return true;
  }
};

// Little endian CDR behind its header of four bytes.
struct Out {
  Bytes bytes{0, 1, 0, 0};
  template <class T>
  void put(T value) {
    while ((bytes.size() - 4) % sizeof(T) != 0) bytes.push_back(0);
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.insert(bytes.end(), raw, raw + sizeof(T));
  }
  void text(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    bytes.insert(bytes.end(), value.begin(), value.end());
    bytes.push_back(0);
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
  void text() { at += get<std::uint32_t>(); }
};

Bytes joint_state(double first) {
  Out out;
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  out.put(static_cast<std::int32_t>(now.tv_sec));
  out.put(static_cast<std::uint32_t>(now.tv_nsec));
  out.text("base");
  out.put(std::uint32_t{6});
  for (int joint = 1; joint <= 6; ++joint) out.text("J_" + std::to_string(joint));
  out.put(std::uint32_t{6});
  for (int joint = 1; joint <= 6; ++joint) out.put(joint == 1 ? first : 0.0);
  out.put(std::uint32_t{0});  // no velocities
  out.put(std::uint32_t{0});  // no efforts
  return out.bytes;
}

double first_position(const Bytes& bytes) {
  In in{bytes};
  in.get<std::int32_t>();
  in.get<std::uint32_t>();
  in.text();
  const auto names = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < names && in.at < bytes.size(); ++i) in.text();
  return in.get<std::uint32_t>() > 0 ? in.get<double>() : 0.0;
}

class Reader final : public fd::DataReaderListener {
 public:
  explicit Reader(std::string topic) : topic_(std::move(topic)) {}
  void on_data_available(fd::DataReader* reader) override {
    Bytes bytes;
    fd::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == kOk) {
      if (!info.valid_data || only_passing) continue;
      const bool joints = topic_ == "rt/cellmirror/joint_states";
      print(joints ? "joints" : "summary", topic_, joints ? member("position", first_position(bytes)) : "");
    }
  }
  void on_subscription_matched(fd::DataReader*, const fd::SubscriptionMatchedStatus& status) override {
    print(status.current_count_change > 0 ? "matched" : "unmatched", topic_);
  }

 private:
  std::string topic_;
};

class Writer final : public fd::DataWriterListener {
 public:
  explicit Writer(std::string topic) : topic_(std::move(topic)) {}
  void on_publication_matched(fd::DataWriter*, const fd::PublicationMatchedStatus& status) override {
    print(status.current_count_change > 0 ? "matched" : "unmatched", topic_);
  }

 private:
  std::string topic_;
};

// Endpoints as those of a node with ROS 2's default profile: reliable, volatile, the last 10.
struct Node {
  fd::DomainParticipant* participant;
  fd::Publisher* publisher;
  fd::Subscriber* subscriber;

  Node() {
    participant = fd::DomainParticipantFactory::get_instance()->create_participant(0, fd::PARTICIPANT_QOS_DEFAULT);
    publisher = participant->create_publisher(fd::PUBLISHER_QOS_DEFAULT);
    subscriber = participant->create_subscriber(fd::SUBSCRIBER_QOS_DEFAULT);
  }
  fd::Topic* topic(const std::string& name, const std::string& type) {
    fd::TypeSupport support(new BytesType(type));
    support.register_type(participant);
    return participant->create_topic(name, type, fd::TOPIC_QOS_DEFAULT);
  }
  template <class Qos>
  static Qos qos() {
    Qos made;
    made.reliability().kind = fd::RELIABLE_RELIABILITY_QOS;
    made.durability().kind = fd::VOLATILE_DURABILITY_QOS;
    made.history().kind = fd::KEEP_LAST_HISTORY_QOS;
    made.history().depth = 10;
    made.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return made;
  }
  fd::DataWriter* write(const std::string& name, const std::string& type, fd::DataWriterListener* listener) {
    return publisher->create_datawriter(topic(name, type), qos<fd::DataWriterQos>(), listener);
  }
  void read(const std::string& name, const std::string& type, bool transient, fd::DataReaderListener* listener) {
    auto wanted = qos<fd::DataReaderQos>();
    if (transient) wanted.durability().kind = fd::TRANSIENT_LOCAL_DURABILITY_QOS;
    subscriber->create_datareader(topic(name, type), wanted, listener);
  }
};

volatile std::sig_atomic_t ended = 0;
void end(int) { ended = 1; }

void publish(fd::DataWriter& writer) {
  timespec next{};
  clock_gettime(CLOCK_MONOTONIC, &next);
  for (long n = 1; ended == 0; ++n) {
    Bytes message = joint_state(kStepRad * static_cast<double>(n));
    const double before = now_s();
    writer.write(static_cast<void*>(&message));
    if (!only_passing) print("written", "rt/joint_states", member("took_s", now_s() - before));
    next.tv_nsec += kPeriodNs;
    if (next.tv_nsec >= 1'000'000'000) {
      next.tv_nsec -= 1'000'000'000;
      ++next.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 2 ? argv[1] : "";
  if (what == "version") return std::puts(VERSION_TEXT) < 0 ? 1 : 0;
  if (what != "talker" && what != "passer-by") return 2;
  only_passing = what == "passer-by";
  std::signal(SIGTERM, end);
  std::signal(SIGINT, end);

  print("started", "");
  const double before = now_s();
  Node node;
  Reader joints("rt/cellmirror/joint_states"), summary("rt/cellmirror/summary");
  Writer writer(only_passing ? "rt/passer_by" : "rt/joint_states");
  node.read("rt/cellmirror/joint_states", kJointState, false, &joints);
  node.read("rt/cellmirror/summary", kString, true, &summary);
  fd::DataWriter* out = node.write(only_passing ? "rt/passer_by" : "rt/joint_states", kJointState, &writer);
  print("made", "", member("took_s", now_s() - before));
  publish(*out);
  node.participant->delete_contained_entities();
  fd::DomainParticipantFactory::get_instance()->delete_participant(node.participant);
}
