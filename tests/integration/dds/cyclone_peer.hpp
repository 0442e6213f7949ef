// A peer that shares no code with ours: Cyclone DDS with types compiled from IDL by its own compiler.
#pragma once

#include <dds/dds.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
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

struct PlainRange {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame_id;
  int radiation_type = -1;
  float field_of_view = 0, min_range = 0, max_range = 0, range = 0;
  std::optional<float> variance;  // none in Humble's type
};

struct PlainWrench {
  std::string frame_id;
  std::array<double, 3> force{};
  std::array<double, 3> torque{};
};

struct PlainImage {
  std::int32_t sec = 0;
  std::string frame_id, format;
  std::vector<std::uint8_t> data;
};

struct PlainStatus {
  int level = -1;
  std::string name, message, hardware_id;
  std::vector<std::pair<std::string, std::string>> values;
};

struct PlainMarker {
  std::string frame_id, ns;
  int id = 0, type = 0, action = 0;
  double scale_x = 0;
  float red = 0;
  int lifetime_sec = 0;
  std::vector<std::array<double, 3>> points;
  std::size_t colours = 0;
  bool rest_is_empty = false;  // textures, texts and meshes
};

struct PlainTrajectoryPoint {
  std::vector<double> positions = {}, velocities = {}, accelerations = {};
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

struct PlainTrajectory {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::vector<std::string> joints = {};
  std::vector<PlainTrajectoryPoint> points = {};
};

struct PlainControllerState {
  std::vector<std::string> joints;
  std::vector<double> reference, feedback, error;  // positions
  double speed = 0;
};

struct PlainNode {
  std::string space, name;
  std::vector<std::array<std::uint8_t, 16>> readers, writers;
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
  [[nodiscard]] dds_entity_t trajectory_writer(const std::string& topic);
  [[nodiscard]] dds_entity_t controller_state_reader(const std::string& topic);
  // Of ros_discovery_info, as ROS 2 asks for it: reliable and transient local.
  [[nodiscard]] dds_entity_t node_reader();
  // What the writers of a topic announce as USER_DATA.
  [[nodiscard]] std::vector<std::string> user_data_of_writers(const std::string& topic) const;
  [[nodiscard]] std::vector<std::array<std::uint8_t, 16>> guids_of_writers(const std::string& topic) const;
  [[nodiscard]] dds_entity_t tf_reader(const std::string& topic);
  // `humble`: with the type that this release has.
  [[nodiscard]] dds_entity_t range_reader(const std::string& topic, bool humble);
  [[nodiscard]] dds_entity_t wrench_reader(const std::string& topic);
  [[nodiscard]] dds_entity_t image_reader(const std::string& topic);
  [[nodiscard]] dds_entity_t diagnostics_reader(const std::string& topic);
  [[nodiscard]] dds_entity_t marker_reader(const std::string& topic);
  // As RViz asks for a robot's description: reliable and transient local.
  [[nodiscard]] dds_entity_t description_reader(const std::string& topic);

  static bool write(dds_entity_t writer, const PlainJointState& message);
  static bool write(dds_entity_t writer, const PlainTrajectory& message);
  static std::vector<PlainControllerState> take_controller_states(dds_entity_t reader);
  static std::vector<PlainNode> take_nodes(dds_entity_t reader);  // of all messages
  static std::vector<PlainJointState> take_joint_states(dds_entity_t reader);
  static std::vector<PlainTransform> take_transforms(dds_entity_t reader);
  static std::vector<PlainRange> take_ranges(dds_entity_t reader, bool humble);
  static std::vector<PlainWrench> take_wrenches(dds_entity_t reader);
  static std::vector<PlainImage> take_images(dds_entity_t reader);
  static std::vector<PlainStatus> take_diagnostics(dds_entity_t reader);
  static std::vector<PlainMarker> take_markers(dds_entity_t reader);
  static std::vector<std::string> take_texts(dds_entity_t reader);
  static int matched_readers(dds_entity_t writer);
  static int matched_writers(dds_entity_t reader);

 private:
  [[nodiscard]] dds_entity_t reader(const dds_topic_descriptor_t& type, const std::string& name) const;
  [[nodiscard]] dds_entity_t topic(const dds_topic_descriptor_t& type, const std::string& name) const;

  dds_entity_t domain_;
  dds_entity_t participant_;
};

}  // namespace cellmirror::dds::test
