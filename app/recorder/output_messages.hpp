// What a recording has beside ROS 2's states: collisions and distances as JSON, lines of the log. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/recorder/topic.hpp"
#include "app/snapshot/foot_switch_snapshot.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/force_state.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/tissue_output.hpp"

namespace cellmirror::app {

// The topics of each gateway, those of robots and sensors aside.
struct OutputTopics {
  static TopicPtr tf();
  static TopicPtr log();
  static TopicPtr collisions();
  static TopicPtr collision_events();
  static TopicPtr forces();
  static TopicPtr commands();
  static TopicPtr alarms();
  static TopicPtr status();
  static TopicPtr foot_switches();
  static TopicPtr foot_switch_changes();
  // "/cellmirror/range/ID", "/cellmirror/tcp_wrench/ID".
  static TopicPtr range(std::string_view sensor);
  static TopicPtr wrench(std::string_view robot);
  // "/inputs/can/ROBOT": the frames of its stream, as they came.
  static TopicPtr can_frames(std::string_view robot);
  // "/inputs/dds/ROBOT", "/inputs/rtde/ROBOT": what its stream received, byte by byte.
  static TopicPtr dds_samples(std::string_view robot);
  static TopicPtr rtde_packages(std::string_view robot);
  // "/cellmirror/pictures/VIEW": sensor_msgs/msg/CompressedImage.
  static TopicPtr pictures(std::string_view view);
  // "/cellmirror/tissue/OBJECT": the surface of a deformable object; clips, drops, smoke and pool of all; and surfaces
  // as visualization_msgs/msg/MarkerArray, for people's tools.
  static TopicPtr tissue(std::string_view object);
  static TopicPtr tissue_effects();
  static TopicPtr tissue_markers();
  static TopicPtr tissue_events();
  // With "joint:NAME" = "ROBOT.JOINT" for each joint.
  static TopicPtr joint_states(mcap::Texts joints);
};

[[nodiscard]] std::string collisions_message(const ProximityState& state);
[[nodiscard]] std::string collision_event_message(const ProximityEvent& event);
// `text`: the event as a sentence; `wall_ns`: the time of the event.
[[nodiscard]] std::string tissue_event_message(const NamedTissueEvent& event, std::string_view text,
                                               std::int64_t wall_ns);
[[nodiscard]] std::string forces_message(const ForceState& state);
// `edges`: changes since the start; `on`: the inputs that are on, the first of them.
[[nodiscard]] std::string foot_switches_message(std::uint64_t edges, std::span<const std::uint32_t> on);
[[nodiscard]] std::string foot_switch_change_message(const FootSwitchChange& change, std::int64_t wall_ns);
// `wall_ns`: when it was received, or given to the channel.
[[nodiscard]] std::string can_frame_message(const CanFrame& frame, std::int64_t wall_ns, bool sent);
// rcl_interfaces/msg/Log; `out` is overwritten.
void encode_log(dds::RosTime stamp, LogLevel level, std::string_view kind, std::string_view text,
                std::vector<std::byte>& out);

}  // namespace cellmirror::app
