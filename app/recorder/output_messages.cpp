#include "app/recorder/output_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/recorder/picture_recorder.hpp"
#include "app/recorder/ros2_definitions.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "app/snapshot/proximity_words.hpp"
#include "drivers/can/channel/candump_line.hpp"
#include "drivers/dds/cdr.hpp"
#include "drivers/dds/sensor_ranges.hpp"
#include "rt_core/base/json_writer.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kCollisionsSchema = R"({
"type":"object","title":"what touches and what is near, for one posture","properties":{
"posture_time_ns":{"type":"integer"},"sequence":{"type":"integer"},"pairs":{"type":"integer"},
"warning_distance_m":{"type":"number"},"nearest_m":{"type":"number"},"touching_count":{"type":"integer"},
"touching":{"type":"array","items":{"type":"object","properties":{"a":{"type":"string"},"b":{"type":"string"},
"depth_m":{"type":"number"},"point_m":{"type":"array","items":{"type":"number"}},
"normal":{"type":"array","items":{"type":"number"}},"doubtful":{"type":"boolean"}}}},
"near":{"type":"array","items":{"type":"object","properties":{"a":{"type":"string"},"b":{"type":"string"},
"distance_m":{"type":"number"},"point_a_m":{"type":"array","items":{"type":"number"}},
"point_b_m":{"type":"array","items":{"type":"number"}},"within_warning":{"type":"boolean"},
"doubtful":{"type":"boolean"}}}},
"doubts":{"type":"array","items":{"type":"string"}}}})";

constexpr std::string_view kEventSchema = R"({
"type":"object","title":"a pair of bodies that touches, parts, or passes the warning distance","properties":{
"sequence":{"type":"integer"},"posture_time_ns":{"type":"integer"},"change":{"type":"string"},
"a":{"type":"string"},"b":{"type":"string"},"distance_m":{"type":"number"}}})";

constexpr std::string_view kTissueEventSchema = R"({
"type":"object","title":"event of soft tissue, or action of an instrument on it","properties":{
"number":{"type":"integer"},"time_ns":{"type":"integer"},"event":{"type":"string"},"robot":{"type":"string"},
"object":{"type":"string"},"part":{"type":"string"},"limit":{"type":"string"},
"at_m":{"type":"array","items":{"type":"number"}},"value":{"type":"number"},"text":{"type":"string"}}})";

constexpr std::string_view kForcesSchema = R"({
"type":"object","title":"efforts of drives, and forces on tool centre points","properties":{
"posture_time_ns":{"type":"integer"},"sequence":{"type":"integer"},
"robots":{"type":"array","items":{"type":"object","properties":{"id":{"type":"string"},
"efforts":{"type":"array","items":{"type":"number"}},"beyond_limit":{"type":"boolean"},
"tcp_force_n":{"type":"array","items":{"type":"number"}},
"tcp_torque_nm":{"type":"array","items":{"type":"number"}}}}}}})";

constexpr std::string_view kSwitchesSchema = R"({
"type":"object","title":"foot switches and other binary inputs","properties":{
"edges":{"type":"integer"},"on":{"type":"array","items":{"type":"integer"}}}})";

constexpr std::string_view kSwitchChangeSchema = R"({
"type":"object","title":"a change of a foot switch or of another binary input","properties":{
"time_ns":{"type":"integer"},"input":{"type":"integer"},"on":{"type":"boolean"}}})";

constexpr std::string_view kCommandSchema = R"({
"type":"object","title":"a SCRIPT command and its acknowledgement","properties":{
"time":{"type":"string"},"took_s":{"type":"number"},"tick":{"type":"integer"},"loop_command":{"type":"integer"},"source":{"type":"string"},"process":{"type":"integer"},
"user":{"type":"integer"},"session":{"type":"integer"},"peer":{"type":"string"},"place":{"type":"string"},
"run":{"type":"integer"},"command":{"type":"string"},"outcome":{"type":"string"},"answer":{"type":"string"}}})";

constexpr std::string_view kAlarmSchema = R"({
"type":"object","title":"an alarm, when it has changed; times in ms since 1970, UTC","properties":{
"id":{"type":"integer"},"kind":{"type":"string"},"subject":{"type":"string"},"text":{"type":"string"},
"priority":{"type":"string"},"occurrences":{"type":"integer"},"first_ms":{"type":"integer"},
"raised_ms":{"type":"integer"},"cleared_ms":{"type":"integer"},"acknowledged_ms":{"type":"integer"},
"acknowledged_by":{"type":"string"}}})";

constexpr std::string_view kCanSchema = R"({
"type":"object","title":"a CAN frame that a stream received or sent","properties":{
"time_ns":{"type":"integer"},"sent":{"type":"boolean"},"id":{"type":"integer"},
"frame":{"type":"string","description":"as candump writes it"}}})";

constexpr std::string_view kRtdeEncoding = "cellmirror.rtde";

constexpr std::string_view kStatusSchema = R"({"type":"object","title":"the document of cellmirror status"})";

TopicPtr ros2_topic(std::string name, std::string_view type, std::string definition, Importance importance) {
  return std::make_shared<const Topic>(
      Topic{std::move(name), "cdr", std::string(type), "ros2msg", std::move(definition), importance});
}

TopicPtr json_topic(std::string name, std::string_view type, std::string_view schema, Importance importance) {
  return std::make_shared<const Topic>(
      Topic{std::move(name), "json", std::string(type), "jsonschema", std::string(schema), importance});
}

TopicPtr tissue_topic(std::string name, std::string_view encoding, std::string_view type) {
  return std::make_shared<const Topic>(
      Topic{.name = std::move(name),
            .encoding = std::string(encoding),
            .schema_name = std::string(type),
            .schema_encoding = std::string(encoding),
            .schema = "Deformable objects, for cellmirror replay (docs/recording.md). Version 1.",
            .importance = Importance::bulk,
            .of_tissue = true});
}

void write_touching(const ProximityState& state, JsonWriter& out) {
  out.key("touching").begin_array();
  for (std::size_t i = 0; i < std::min(state.touching.size(), kMostPairsTold); ++i) {
    const TouchingPair& pair = state.touching[i];
    out.begin_object()
        .member("a", (*state.names)[pair.a])
        .member("b", (*state.names)[pair.b])
        .member("depth_m", pair.depth_m)
        .member("point_m", pair.point_m)
        .member("normal", pair.normal)
        .member("doubtful", pair.doubtful)
        .end_object();
  }
  out.end_array();
}

void write_near(const ProximityState& state, JsonWriter& out) {
  out.key("near").begin_array();
  for (std::size_t i = 0; i < std::min(state.near.size(), kMostPairsTold); ++i) {
    const NearPair& pair = state.near[i];
    out.begin_object()
        .member("a", (*state.names)[pair.a])
        .member("b", (*state.names)[pair.b])
        .member("distance_m", pair.distance_m)
        .member("point_a_m", pair.point_a_m)
        .member("point_b_m", pair.point_b_m)
        .member("within_warning", pair.within_warning)
        .member("doubtful", pair.doubtful)
        .end_object();
  }
  out.end_array();
}

}  // namespace

TopicPtr OutputTopics::tf() {
  return ros2_topic("/tf", "tf2_msgs/msg/TFMessage", ros2::tf_message(), Importance::bulk);
}
TopicPtr OutputTopics::log() { return ros2_topic("/rosout", "rcl_interfaces/msg/Log", ros2::log(), Importance::event); }
TopicPtr OutputTopics::collisions() {
  return json_topic("/cellmirror/collisions", "cellmirror.Collisions", kCollisionsSchema, Importance::state);
}
TopicPtr OutputTopics::collision_events() {
  return json_topic(std::string(kCollisionEventsTopic), "cellmirror.CollisionEvent", kEventSchema, Importance::event);
}
TopicPtr OutputTopics::tissue_events() {
  return json_topic(std::string(kTissueEventsTopic), "cellmirror.TissueEvent", kTissueEventSchema, Importance::event);
}
TopicPtr OutputTopics::forces() {
  return json_topic("/cellmirror/forces", "cellmirror.Forces", kForcesSchema, Importance::bulk);
}
TopicPtr OutputTopics::commands() {
  return json_topic("/cellmirror/commands", "cellmirror.Command", kCommandSchema, Importance::event);
}
TopicPtr OutputTopics::alarms() {
  return json_topic(std::string(kAlarmsTopic), "cellmirror.Alarm", kAlarmSchema, Importance::event);
}
TopicPtr OutputTopics::status() {
  return json_topic("/cellmirror/status", "cellmirror.Status", kStatusSchema, Importance::bulk);
}
TopicPtr OutputTopics::foot_switches() {
  return json_topic("/inputs/foot_switches", "cellmirror.FootSwitches", kSwitchesSchema, Importance::event);
}
TopicPtr OutputTopics::foot_switch_changes() {
  return json_topic("/inputs/foot_switch_changes", "cellmirror.FootSwitchChange", kSwitchChangeSchema,
                    Importance::event);
}
TopicPtr OutputTopics::range(std::string_view sensor) {
  return ros2_topic(dds::range_topic("/cellmirror/range", sensor), "sensor_msgs/msg/Range", ros2::range(),
                    Importance::state);
}
TopicPtr OutputTopics::wrench(std::string_view robot) {
  return ros2_topic(dds::topic_of("robot", "/cellmirror/tcp_wrench", robot), "geometry_msgs/msg/WrenchStamped",
                    ros2::wrench_stamped(), Importance::state);
}
TopicPtr OutputTopics::can_frames(std::string_view robot) {
  return json_topic(dds::topic_of("robot", "/inputs/can", robot), "cellmirror.CanFrame", kCanSchema, Importance::event);
}
TopicPtr OutputTopics::dds_samples(std::string_view robot) {
  return ros2_topic(dds::topic_of("robot", "/inputs/dds", robot), "sensor_msgs/msg/JointState", ros2::joint_state(),
                    Importance::event);
}
TopicPtr OutputTopics::rtde_packages(std::string_view robot) {
  return std::make_shared<const Topic>(
      Topic{dds::topic_of("robot", "/inputs/rtde", robot), std::string(kRtdeEncoding), "cellmirror.RtdeData",
            std::string(kRtdeEncoding), "A data package of RTDE without its head, as received (docs/recording.md).",
            Importance::event});
}
TopicPtr OutputTopics::pictures(std::string_view view) {
  return std::make_shared<const Topic>(Topic{.name = pictures_topic_name(view),
                                             .encoding = "cdr",
                                             .schema_name = "sensor_msgs/msg/CompressedImage",
                                             .schema_encoding = "ros2msg",
                                             .schema = ros2::compressed_image(),
                                             .importance = Importance::picture,
                                             .view = std::string(view)});
}
TopicPtr OutputTopics::tissue(std::string_view object) {
  constexpr std::string_view kExtension = ".mpo";
  if (object.ends_with(kExtension)) object.remove_suffix(kExtension.size());
  return tissue_topic(dds::topic_of("object", kTissueTopics, object), kTissueEncoding, "cellmirror.TissueSurface");
}
TopicPtr OutputTopics::tissue_effects() {
  return tissue_topic(std::string(kTissueEffectsTopic), kTissueEffectsEncoding, "cellmirror.TissueEffects");
}
TopicPtr OutputTopics::tissue_markers() {
  return std::make_shared<const Topic>(Topic{.name = "/cellmirror/tissue_markers",
                                             .encoding = "cdr",
                                             .schema_name = "visualization_msgs/msg/MarkerArray",
                                             .schema_encoding = "ros2msg",
                                             .schema = ros2::marker_array(),
                                             .importance = Importance::bulk,
                                             .of_tissue = true});
}
TopicPtr OutputTopics::joint_states(mcap::Texts joints) {
  return std::make_shared<const Topic>(Topic{"/joint_states", "cdr", "sensor_msgs/msg/JointState", "ros2msg",
                                             ros2::joint_state(), Importance::state, std::move(joints)});
}

std::string collisions_message(const ProximityState& state) {
  JsonWriter out;
  out.begin_object()
      .member("posture_time_ns", to_wall_clock_ns(state.posture_time))
      .member("sequence", state.sequence)
      .member("pairs", state.pairs)
      .member("warning_distance_m", state.warning_distance_m);
  const NearPair* nearest = state.nearest();
  out.member("nearest_m", nearest == nullptr ? std::optional<double>() : std::optional(nearest->distance_m));
  out.member("touching_count", state.touching.size());
  write_touching(state, out);
  write_near(state, out);
  out.member("doubts", std::span<const std::string>(state.doubts)).end_object();
  return out.take();
}

std::string collision_event_message(const ProximityEvent& event) {
  JsonWriter out;
  out.begin_object()
      .member("sequence", event.sequence)
      .member("posture_time_ns", to_wall_clock_ns(event.posture_time))
      .member("change", word(event.change))
      .member("a", std::string_view(event.a))
      .member("b", std::string_view(event.b))
      .member("distance_m", event.distance_m)
      .end_object();
  return out.take();
}

std::string tissue_event_message(const NamedTissueEvent& event, std::string_view text, std::int64_t wall_ns) {
  JsonWriter out;
  out.begin_object()
      .member("number", event.event.number)
      .member("time_ns", wall_ns)
      .member("event", word(event.event.kind))
      .member("robot", std::string_view(event.robot))
      .member("object", std::string_view(event.object))
      .member("part", part_of(event.event))
      .member("limit", event.event.kind == TissueEventKind::limit ? word(event.event.limit) : std::string_view())
      .member("at_m", event.event.at)
      .member("value", event.event.value)
      .member("text", text)
      .end_object();
  return out.take();
}

std::string forces_message(const ForceState& state) {
  JsonWriter out;
  out.begin_object()
      .member("posture_time_ns", to_wall_clock_ns(state.posture_time))
      .member("sequence", state.sequence)
      .key("robots")
      .begin_array();
  for (const RobotForces& robot : state.robots) {
    bool beyond = false;
    out.begin_object().member("id", std::string_view(robot.id)).key("efforts").begin_array();
    for (const JointForce& joint : robot.joints) {
      out.value(joint.effort);
      beyond = beyond || joint.beyond_limit;
    }
    out.end_array().member("beyond_limit", beyond);
    if (robot.tcp_known) out.member("tcp_force_n", robot.tcp_T.force).member("tcp_torque_nm", robot.tcp_T.torque);
    out.end_object();
  }
  out.end_array().end_object();
  return out.take();
}

std::string foot_switches_message(std::uint64_t edges, std::span<const std::uint32_t> on) {
  JsonWriter out;
  out.begin_object().member("edges", edges).key("on").begin_array();
  for (const std::uint32_t input : on) out.value(input);
  out.end_array().end_object();
  return out.take();
}

std::string foot_switch_change_message(const FootSwitchChange& change, std::int64_t wall_ns) {
  JsonWriter out;
  out.begin_object().member("time_ns", wall_ns).member("input", change.input).member("on", change.on).end_object();
  return out.take();
}

std::string can_frame_message(const CanFrame& frame, std::int64_t wall_ns, bool sent) {
  constexpr std::string_view kInterface = "can";
  // "(time) can 123#00": what is behind the second blank.
  const std::string line = can::format_candump_line(wall_ns, kInterface, frame);
  const std::size_t from = line.find(kInterface) + kInterface.size() + 1;
  JsonWriter out;
  out.begin_object()
      .member("time_ns", wall_ns)
      .member("sent", sent)
      .member("id", frame.id)
      .member("frame", std::string_view(line).substr(std::min(from, line.size())))
      .end_object();
  return out.take();
}

void encode_log(dds::RosTime stamp, LogLevel level, std::string_view kind, std::string_view text,
                std::vector<std::byte>& out) {
  constexpr std::array<std::uint8_t, 4> kLevels = {10, 20, 30, 40};  // rcl_interfaces/msg/Log
  dds::CdrWriter writer(out);
  writer.write(stamp.sec);
  writer.write(stamp.nanosec);
  writer.write(kLevels.at(static_cast<std::size_t>(level)));
  writer.write_text(kind);
  writer.write_text(text);
  writer.write_text("");
  writer.write_text("");
  writer.write(std::uint32_t{0});
}

}  // namespace cellmirror::app
