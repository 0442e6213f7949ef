#include "drivers/mqtt/payloads.hpp"

#include <array>
#include <ranges>
#include <utility>

#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/utf8.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr int kDigits = 9;
constexpr int kDistanceDigits = 6;
constexpr std::size_t kMostReplyText = 4096;
constexpr std::array<std::string_view, 4> kChanges = {"entered_warning", "touched", "parted", "left_warning"};

std::string_view short_text(std::string_view text) { return cut_utf8(text, kMostSummaryText); }

JsonWriter begin_event(const EventStamp& stamp, std::string_view kind, int digits = kDigits) {
  JsonWriter out(digits);
  out.begin_object().member("event", kind).member("number", stamp.number).member("time_ms", stamp.time_ms);
  return out;
}

std::string_view name_of(const std::string& in_short, const std::string& path) {
  return short_text(in_short.empty() ? path : in_short);
}

template <class Get>
void put_joints(JsonWriter& out, const RobotState& robot, std::string_view name, Get get) {
  out.key(name).begin_array();
  for (const RobotJointState& joint : robot.joints) out.value(get(joint));
  out.end_array();
}

}  // namespace

std::string birth_text(const Identity& identity, bool commands, std::int64_t time_ms) {
  JsonWriter out;
  out.begin_object()
      .member("online", true)
      .member("cell", short_text(identity.cell))
      .member("instance", short_text(identity.instance))
      .member("host", short_text(identity.host))
      .member("version", short_text(identity.version))
      .member("commands", commands)
      .member("time_ms", time_ms)
      .end_object();
  return out.take();
}

std::string death_text(std::string_view reason) {
  JsonWriter out;
  out.begin_object().member("online", false).member("reason", reason).end_object();
  return out.take();
}

std::string collision_text(const EventStamp& stamp, const ProximityEvent& event) {
  JsonWriter out = begin_event(stamp, "collision", kDistanceDigits);
  out.member("change", kChanges.at(std::to_underlying(event.change)))
      .member("a", name_of(event.short_a, event.a))
      .member("b", name_of(event.short_b, event.b))
      .member("distance_m", event.distance_m)
      .end_object();
  return out.take();
}

std::string stream_text(const EventStamp& stamp, const RobotSummary& robot, DataState was) {
  JsonWriter out = begin_event(stamp, "stream", kDistanceDigits);
  out.member("robot", short_text(robot.id)).member("state", word(robot.state)).member("was", word(was));
  out.member("age_s", robot.age_s).end_object();
  return out.take();
}

std::string fault_text(const EventStamp& stamp, const CellSummary& summary) {
  JsonWriter out = begin_event(stamp, "fault");
  out.member("faults", summary.loop.faults).member("missed", summary.loop.missed).key("reasons").begin_array();
  for (const std::string& reason : summary.reasons | std::views::take(kMostSummaryReasons))
    out.value(short_text(reason));
  out.end_array().end_object();
  return out.take();
}

// The alarm is JSON already: it is put in as it is.
std::string alarm_text(const EventStamp& stamp, std::string_view alarm) {
  JsonWriter out = begin_event(stamp, "alarm");
  out.end_object();
  std::string text = out.take();
  text.pop_back();
  text += ",\"alarm\":";
  text += alarm;
  text += '}';
  return text;
}

std::string joint_states_text(const RobotState& robot, std::int64_t time_ms) {
  JsonWriter out(kDigits);
  out.begin_object()
      .member("time_ms", time_ms)
      .member("robot", short_text(robot.id))
      .member("mode", robot_mode_word(robot.online))
      .member("state", word(robot.state));
  out.key("name").begin_array();
  for (const RobotJointState& joint : robot.joints) out.value(short_text(joint.name));
  out.end_array();
  put_joints(out, robot, "position", [](const RobotJointState& joint) { return joint.position; });
  put_joints(out, robot, "velocity", [](const RobotJointState& joint) { return joint.velocity; });
  put_joints(out, robot, "effort", [](const RobotJointState& joint) { return joint.effort; });
  out.end_object();
  return out.take();
}

std::string reply_text(std::string_view id, bool done, std::string_view text, std::int64_t time_ms) {
  JsonWriter out;
  out.begin_object()
      .member("done", done)
      .member("text", cut_utf8(text, kMostReplyText))
      .member("time_ms", time_ms)
      .end_object();
  std::string reply = out.take();
  if (id.empty()) return reply;
  reply.pop_back();
  reply += ",\"id\":";
  reply += id;
  reply += '}';
  return reply;
}

}  // namespace cellmirror::mqtt
