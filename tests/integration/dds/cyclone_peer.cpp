#include "cyclone_peer.hpp"

#include "cyclone_samples.hpp"

#include <cstdlib>

namespace cellmirror::dds::test {

namespace {

constexpr char kConfig[] = R"(
<Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain>)";

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

}  // namespace

CyclonePeer::CyclonePeer(int domain) {
  const auto id = static_cast<dds_domainid_t>(domain);
  // Set from outside: a test with machines of its own.
  const char* config = std::getenv("CYCLONEDDS_URI");
  domain_ = checked(dds_create_domain(id, config != nullptr ? config : kConfig), "Cyclone domain");
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

dds_entity_t CyclonePeer::reader(const dds_topic_descriptor_t& type, const std::string& name) const {
  const Qos qos(true);
  return checked(dds_create_reader(participant_, topic(type, name), qos.get(), nullptr), "Cyclone reader");
}

dds_entity_t CyclonePeer::tf_reader(const std::string& name) { return reader(tf2_msgs_msg_dds__TFMessage__desc, name); }

dds_entity_t CyclonePeer::wrench_reader(const std::string& name) {
  return reader(geometry_msgs_msg_dds__WrenchStamped__desc, name);
}

dds_entity_t CyclonePeer::image_reader(const std::string& name) {
  return reader(sensor_msgs_msg_dds__CompressedImage__desc, name);
}

dds_entity_t CyclonePeer::range_reader(const std::string& name, bool humble) {
  if (!humble) return reader(sensor_msgs_msg_dds__Range__desc, name);
  // Without type information, which tells the type's own name.
  const dds_topic_descriptor_t& own = humble_msg_dds__Range__desc;
  const dds_topic_descriptor_t type{.m_size = own.m_size,
                                    .m_align = own.m_align,
                                    .m_flagset = 0,
                                    .m_nkeys = 0,
                                    .m_typename = "sensor_msgs::msg::dds_::Range_",
                                    .m_keys = nullptr,
                                    .m_nops = own.m_nops,
                                    .m_ops = own.m_ops,
                                    .m_meta = "",
                                    .type_information = {},
                                    .type_mapping = {},
                                    .restrict_data_representation = 0};
  return reader(type, name);
}

dds_entity_t CyclonePeer::diagnostics_reader(const std::string& name) {
  return reader(diagnostic_msgs_msg_dds__DiagnosticArray__desc, name);
}

dds_entity_t CyclonePeer::marker_reader(const std::string& name) {
  return reader(visualization_msgs_msg_dds__MarkerArray__desc, name);
}

dds_entity_t CyclonePeer::description_reader(const std::string& name) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const dds_entity_t reader =
      dds_create_reader(participant_, topic(std_msgs_msg_dds__String__desc, name), qos, nullptr);
  dds_delete_qos(qos);
  return checked(reader, "Cyclone reader");
}

std::vector<std::string> CyclonePeer::take_texts(dds_entity_t reader) {
  std::vector<std::string> taken;
  take_all<std_msgs_msg_dds__String_>(
      reader, [&](const std_msgs_msg_dds__String_& sample) { taken.emplace_back(sample.data); });
  return taken;
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

namespace {

template <class Sample>
PlainRange plain(const Sample& sample) {
  PlainRange range;
  range.sec = sample.header.stamp.sec;
  range.nanosec = sample.header.stamp.nanosec;
  range.frame_id = sample.header.frame_id;
  range.radiation_type = sample.radiation_type;
  range.field_of_view = sample.field_of_view;
  range.min_range = sample.min_range;
  range.max_range = sample.max_range;
  range.range = sample.range;
  return range;
}

PlainMarker plain(const visualization_msgs_msg_dds__Marker_& sample) {
  PlainMarker marker;
  marker.frame_id = sample.header.frame_id;
  marker.ns = sample.ns;
  marker.id = sample.id;
  marker.type = sample.type;
  marker.action = sample.action;
  marker.scale_x = sample.scale.x;
  marker.red = sample.color.r;
  marker.lifetime_sec = sample.lifetime.sec;
  for (std::uint32_t i = 0; i < sample.points._length; ++i) {
    const auto& point = sample.points._buffer[i];
    marker.points.push_back({point.x, point.y, point.z});
  }
  marker.colours = sample.colors._length;
  const std::string texts = std::string(sample.texture_resource) + sample.texture.header.frame_id +
                            sample.texture.format + sample.text + sample.mesh_resource + sample.mesh_file.filename;
  marker.rest_is_empty = texts.empty() && sample.texture.data._length == 0 && sample.uv_coordinates._length == 0 &&
                         sample.mesh_file.data._length == 0 && !sample.mesh_use_embedded_materials;
  return marker;
}

}  // namespace

std::vector<PlainRange> CyclonePeer::take_ranges(dds_entity_t reader, bool humble) {
  std::vector<PlainRange> taken;
  if (humble) {
    take_all<humble_msg_dds__Range_>(reader, [&](const auto& sample) { taken.push_back(plain(sample)); });
  } else {
    take_all<sensor_msgs_msg_dds__Range_>(reader, [&](const auto& sample) {
      taken.push_back(plain(sample));
      taken.back().variance = sample.variance;
    });
  }
  return taken;
}

std::vector<PlainWrench> CyclonePeer::take_wrenches(dds_entity_t reader) {
  std::vector<PlainWrench> taken;
  take_all<geometry_msgs_msg_dds__WrenchStamped_>(reader, [&](const auto& sample) {
    const auto& force = sample.wrench.force;
    const auto& torque = sample.wrench.torque;
    taken.push_back({sample.header.frame_id, {force.x, force.y, force.z}, {torque.x, torque.y, torque.z}});
  });
  return taken;
}

std::vector<PlainImage> CyclonePeer::take_images(dds_entity_t reader) {
  std::vector<PlainImage> taken;
  take_all<sensor_msgs_msg_dds__CompressedImage_>(reader, [&](const auto& sample) {
    const std::uint8_t* first = sample.data._buffer;
    taken.push_back(
        {sample.header.stamp.sec, sample.header.frame_id, sample.format, {first, first + sample.data._length}});
  });
  return taken;
}

std::vector<PlainStatus> CyclonePeer::take_diagnostics(dds_entity_t reader) {
  std::vector<PlainStatus> taken;
  take_all<diagnostic_msgs_msg_dds__DiagnosticArray_>(reader, [&](const auto& sample) {
    for (std::uint32_t i = 0; i < sample.status._length; ++i) {
      const auto& from = sample.status._buffer[i];
      PlainStatus& status = taken.emplace_back();
      status.level = from.level;
      status.name = from.name;
      status.message = from.message;
      status.hardware_id = from.hardware_id;
      for (std::uint32_t v = 0; v < from.values._length; ++v) {
        status.values.emplace_back(from.values._buffer[v].key, from.values._buffer[v].value);
      }
    }
  });
  return taken;
}

std::vector<PlainMarker> CyclonePeer::take_markers(dds_entity_t reader) {
  std::vector<PlainMarker> taken;
  take_all<visualization_msgs_msg_dds__MarkerArray_>(reader, [&](const auto& sample) {
    for (std::uint32_t i = 0; i < sample.markers._length; ++i) taken.push_back(plain(sample.markers._buffer[i]));
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
