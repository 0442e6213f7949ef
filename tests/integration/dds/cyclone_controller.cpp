// Trajectories, states of controllers, and what ROS 2 tells of nodes, by Cyclone DDS.
#include <cstring>

#include "cyclone_peer.hpp"
#include "cyclone_samples.hpp"

namespace cellmirror::dds::test {

namespace {

std::vector<double> values_of(const dds_sequence_double& from) { return {from._buffer, from._buffer + from._length}; }

std::vector<std::array<std::uint8_t, 16>> gids_of(const dds_sequence_rmw_dds_common_msg_dds__Gid_& from) {
  std::vector<std::array<std::uint8_t, 16>> out(from._length);
  for (std::uint32_t i = 0; i < from._length; ++i) std::memcpy(out[i].data(), from._buffer[i].data, 16);
  return out;
}

// Calls `use` with each writer of the topic that is known.
template <class Use>
void for_each_writer(dds_entity_t participant, const std::string& topic, Use use) {
  const dds_entity_t reader =
      checked(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr), "builtin reader");
  take_all<dds_builtintopic_endpoint_t>(reader, [&](const dds_builtintopic_endpoint_t& endpoint) {
    if (endpoint.topic_name == topic) use(endpoint);
  });
  dds_delete(reader);
}

}  // namespace

dds_entity_t CyclonePeer::trajectory_writer(const std::string& name) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(2));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
  const dds_entity_t writer =
      dds_create_writer(participant_, topic(trajectory_msgs_msg_dds__JointTrajectory__desc, name), qos, nullptr);
  dds_delete_qos(qos);
  return checked(writer, "Cyclone writer");
}

dds_entity_t CyclonePeer::controller_state_reader(const std::string& name) {
  return reader(control_msgs_msg_dds__JointTrajectoryControllerState__desc, name);
}

dds_entity_t CyclonePeer::node_reader() {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const dds_entity_t made = dds_create_reader(
      participant_, topic(rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc, "ros_discovery_info"), qos, nullptr);
  dds_delete_qos(qos);
  return checked(made, "Cyclone reader");
}

std::vector<std::string> CyclonePeer::user_data_of_writers(const std::string& topic) const {
  std::vector<std::string> out;
  for_each_writer(participant_, topic, [&](const dds_builtintopic_endpoint_t& endpoint) {
    void* data = nullptr;
    std::size_t size = 0;
    if (!dds_qget_userdata(endpoint.qos, &data, &size)) return;
    out.emplace_back(static_cast<const char*>(data), size);
    dds_free(data);
  });
  return out;
}

std::vector<std::array<std::uint8_t, 16>> CyclonePeer::guids_of_writers(const std::string& topic) const {
  std::vector<std::array<std::uint8_t, 16>> out;
  for_each_writer(participant_, topic, [&](const dds_builtintopic_endpoint_t& endpoint) {
    std::memcpy(out.emplace_back().data(), endpoint.key.v, 16);
  });
  return out;
}

bool CyclonePeer::write(dds_entity_t writer, const PlainTrajectory& message) {
  std::vector<char*> names;
  for (const std::string& name : message.joints) names.push_back(const_cast<char*>(name.c_str()));
  std::vector<trajectory_msgs_msg_dds__JointTrajectoryPoint_> points;
  for (const PlainTrajectoryPoint& point : message.points) {
    trajectory_msgs_msg_dds__JointTrajectoryPoint_& out = points.emplace_back();
    out.positions = view(point.positions);
    out.velocities = view(point.velocities);
    out.accelerations = view(point.accelerations);
    out.time_from_start = {point.sec, point.nanosec};
  }
  const auto n = static_cast<std::uint32_t>(names.size());
  const auto m = static_cast<std::uint32_t>(points.size());
  char nothing[] = "";
  trajectory_msgs_msg_dds__JointTrajectory_ sample{};
  sample.header.stamp = {message.sec, message.nanosec};
  sample.header.frame_id = nothing;
  sample.joint_names = {n, n, names.data(), false};
  sample.points = {m, m, points.data(), false};
  return dds_write(writer, &sample) == DDS_RETCODE_OK;
}

std::vector<PlainControllerState> CyclonePeer::take_controller_states(dds_entity_t reader) {
  std::vector<PlainControllerState> taken;
  using Sample = control_msgs_msg_dds__JointTrajectoryControllerState_;
  take_all<Sample>(reader, [&](const Sample& sample) {
    PlainControllerState& state = taken.emplace_back();
    state.joints.assign(sample.joint_names._buffer, sample.joint_names._buffer + sample.joint_names._length);
    state.reference = values_of(sample.reference.positions);
    state.feedback = values_of(sample.feedback.positions);
    state.error = values_of(sample.error.positions);
    state.speed = sample.speed_scaling_factor;
  });
  return taken;
}

std::vector<PlainNode> CyclonePeer::take_nodes(dds_entity_t reader) {
  std::vector<PlainNode> taken;
  using Sample = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;
  take_all<Sample>(reader, [&](const Sample& sample) {
    for (std::uint32_t i = 0; i < sample.node_entities_info_seq._length; ++i) {
      const auto& node = sample.node_entities_info_seq._buffer[i];
      taken.push_back(
          {node.node_namespace, node.node_name, gids_of(node.reader_gid_seq), gids_of(node.writer_gid_seq)});
    }
  });
  return taken;
}

}  // namespace cellmirror::dds::test
