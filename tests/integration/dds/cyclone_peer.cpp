#include "cyclone_peer.hpp"

#include <stdexcept>

#include "sensor_msgs.h"

namespace cellmirror::dds::test {

namespace {

constexpr char kConfig[] = R"(
<Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain>)";

dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity < 0) throw std::runtime_error(std::string(what) + ": " + dds_strretcode(-entity));
  return entity;
}

class Qos {
 public:
  explicit Qos(bool reliable) : qos_(dds_create_qos()) {
    dds_qset_reliability(qos_, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_MSECS(100));
    dds_qset_history(qos_, DDS_HISTORY_KEEP_LAST, 1000);
  }
  ~Qos() { dds_delete_qos(qos_); }
  Qos(const Qos&) = delete;
  Qos& operator=(const Qos&) = delete;
  [[nodiscard]] const dds_qos_t* get() const { return qos_; }

 private:
  dds_qos_t* qos_;
};

dds_sequence_double view(const std::vector<double>& values) {
  const auto n = static_cast<std::uint32_t>(values.size());
  return {n, n, const_cast<double*>(values.data()), false};
}

template <class Sample, class Use>
void take_all(dds_entity_t reader, Use use) {
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info;
    const dds_return_t taken = dds_take(reader, &sample, &info, 1, 1);
    if (taken <= 0) return;
    if (info.valid_data) use(*static_cast<const Sample*>(sample));
    dds_return_loan(reader, &sample, taken);
  }
}

}  // namespace

CyclonePeer::CyclonePeer(int domain) {
  const auto id = static_cast<dds_domainid_t>(domain);
  domain_ = checked(dds_create_domain(id, kConfig), "Cyclone domain");
  participant_ = checked(dds_create_participant(id, nullptr, nullptr), "Cyclone participant");
}

CyclonePeer::~CyclonePeer() { dds_delete(domain_); }

dds_entity_t CyclonePeer::topic(const dds_topic_descriptor_t& type, const std::string& name) const {
  return checked(dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr), "Cyclone topic");
}

dds_entity_t CyclonePeer::joint_state_writer(const std::string& name, bool reliable) {
  const Qos qos(reliable);
  return checked(
      dds_create_writer(participant_, topic(sensor_msgs_msg_dds__JointState__desc, name), qos.get(), nullptr),
      "Cyclone writer");
}

dds_entity_t CyclonePeer::joint_state_reader(const std::string& name, bool reliable) {
  const Qos qos(reliable);
  return checked(
      dds_create_reader(participant_, topic(sensor_msgs_msg_dds__JointState__desc, name), qos.get(), nullptr),
      "Cyclone reader");
}

dds_entity_t CyclonePeer::tf_reader(const std::string& name) {
  const Qos qos(true);
  return checked(dds_create_reader(participant_, topic(tf2_msgs_msg_dds__TFMessage__desc, name), qos.get(), nullptr),
                 "Cyclone reader");
}

bool CyclonePeer::write(dds_entity_t writer, const PlainJointState& message) {
  std::vector<char*> names;
  for (const std::string& name : message.name) names.push_back(const_cast<char*>(name.c_str()));
  const auto n = static_cast<std::uint32_t>(names.size());
  sensor_msgs_msg_dds__JointState_ sample{};
  sample.header.stamp = {message.sec, message.nanosec};
  sample.header.frame_id = const_cast<char*>(message.frame_id.c_str());
  sample.name = {n, n, names.data(), false};
  sample.position = view(message.position);
  sample.velocity = view(message.velocity);
  sample.effort = view(message.effort);
  return dds_write(writer, &sample) == DDS_RETCODE_OK;
}

std::vector<PlainJointState> CyclonePeer::take_joint_states(dds_entity_t reader) {
  std::vector<PlainJointState> taken;
  take_all<sensor_msgs_msg_dds__JointState_>(reader, [&](const sensor_msgs_msg_dds__JointState_& sample) {
    PlainJointState& message = taken.emplace_back();
    message.sec = sample.header.stamp.sec;
    message.nanosec = sample.header.stamp.nanosec;
    message.frame_id = sample.header.frame_id;
    message.name.assign(sample.name._buffer, sample.name._buffer + sample.name._length);
    message.position.assign(sample.position._buffer, sample.position._buffer + sample.position._length);
    message.velocity.assign(sample.velocity._buffer, sample.velocity._buffer + sample.velocity._length);
    message.effort.assign(sample.effort._buffer, sample.effort._buffer + sample.effort._length);
  });
  return taken;
}

std::vector<PlainTransform> CyclonePeer::take_transforms(dds_entity_t reader) {
  std::vector<PlainTransform> taken;
  take_all<tf2_msgs_msg_dds__TFMessage_>(reader, [&](const tf2_msgs_msg_dds__TFMessage_& sample) {
    for (std::uint32_t i = 0; i < sample.transforms._length; ++i) {
      const auto& from = sample.transforms._buffer[i];
      const auto& t = from.transform.translation;
      const auto& r = from.transform.rotation;
      taken.push_back({from.header.stamp.sec,
                       from.header.stamp.nanosec,
                       from.header.frame_id,
                       from.child_frame_id,
                       {t.x, t.y, t.z},
                       {r.x, r.y, r.z, r.w}});
    }
  });
  return taken;
}

int CyclonePeer::matched_readers(dds_entity_t writer) {
  dds_publication_matched_status_t status;
  return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK ? static_cast<int>(status.current_count)
                                                                               : 0;
}

int CyclonePeer::matched_writers(dds_entity_t reader) {
  dds_subscription_matched_status_t status;
  return dds_get_subscription_matched_status(reader, &status) == DDS_RETCODE_OK ? static_cast<int>(status.current_count)
                                                                                : 0;
}

}  // namespace cellmirror::dds::test
