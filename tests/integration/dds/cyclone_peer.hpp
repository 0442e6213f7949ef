// A peer that shares no code with ours: Cyclone DDS with types compiled from IDL by its own compiler.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cellmirror::dds::test {

struct PlainJointState {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame_id = {};
  std::vector<std::string> name = {};
  std::vector<double> position = {}, velocity = {}, effort = {};
};

struct PlainTransform {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string parent, child;
  double translation[3] = {};
  double rotation[4] = {};  // x, y, z, w
};

// One participant on the loopback interface. At most one per domain and process at a time.
class CyclonePeer {
 public:
  explicit CyclonePeer(int domain);
  ~CyclonePeer();
  CyclonePeer(const CyclonePeer&) = delete;
  CyclonePeer& operator=(const CyclonePeer&) = delete;

  [[nodiscard]] dds_entity_t joint_state_writer(const std::string& topic, bool reliable);
  [[nodiscard]] dds_entity_t joint_state_reader(const std::string& topic, bool reliable);
  [[nodiscard]] dds_entity_t tf_reader(const std::string& topic);

  static bool write(dds_entity_t writer, const PlainJointState& message);
  static std::vector<PlainJointState> take_joint_states(dds_entity_t reader);
  static std::vector<PlainTransform> take_transforms(dds_entity_t reader);
  static int matched_readers(dds_entity_t writer);
  static int matched_writers(dds_entity_t reader);

 private:
  [[nodiscard]] dds_entity_t topic(const dds_topic_descriptor_t& type, const std::string& name) const;

  dds_entity_t domain_;
  dds_entity_t participant_;
};

}  // namespace cellmirror::dds::test
