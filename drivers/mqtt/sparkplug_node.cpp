#include "drivers/mqtt/sparkplug_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ranges>
#include <utility>

#include "drivers/mqtt/topics.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/utf8.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr const char* kSessionMetric = "bdSeq";
constexpr std::size_t kMostMetrics = 3 + 2 * kMaxJointsPerRobot;  // of a device

std::string cut_text(std::string_view value) { return std::string(cut_utf8(drawable_utf8(value), kMostSummaryText)); }

SparkplugValue number(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return std::monostate();
  return *value;
}

SparkplugValue count(std::uint64_t value) { return static_cast<std::int64_t>(value); }

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& one : texts | std::views::take(kMostSummaryReasons))
    out += (out.empty() ? "" : "; ") + cut_text(one);
  return out;
}

// The robots that are devices. Hosts compare device ids without regard to case (specification 3.0.0, 4.1), so only the
// first of several that differ by case can be one; robots loaded by SCRIPT are not checked by the cell file.
struct Chosen {
  std::vector<const RobotSummary*> devices;
  std::vector<std::string> left_out;  // for people
};

Chosen choose_devices(const CellSummary& summary) {
  Chosen out;
  std::map<std::string, std::string> seen;
  for (const RobotSummary& robot : summary.robots | std::views::take(kMostSummaryRobots)) {
    const auto [first, is_new] = seen.emplace(lower_case(robot.id), robot.id);
    if (is_new) {
      out.devices.push_back(&robot);
    } else {
      out.left_out.push_back(
          fmt::format("the robot {} is not sent by Sparkplug: its id differs from {} by case only; rename one of them",
                      robot.id, first->second));
    }
  }
  return out;
}

// A robot with a stream has current values only while the stream has data.
bool has_current_values(const RobotSummary& robot, bool has_stream) {
  if (!robot.mirrored) return !has_stream;
  return robot.state != DataState::none && robot.state != DataState::lost;
}

SparkplugMetric session_metric(std::uint8_t session) {
  return {kSessionMetric, SparkplugType::int64, std::int64_t{session}};
}

}  // namespace

void SparkplugNode::Metrics::set(const std::string& name, SparkplugType type, SparkplugValue value) {
  const auto [place, is_new] = by_name.try_emplace(name, Metric{type, {}});
  // A metric that no birth message has told may not be in a later one (6.4.17).
  if (is_new) born = false;
  Metric& metric = place->second;
  if (!is_new && metric.value == value) return;
  metric.value = std::move(value);
  metric.changed = true;
}

std::vector<SparkplugMetric> SparkplugNode::Metrics::take(bool all) {
  std::vector<SparkplugMetric> out;
  for (auto& [name, metric] : by_name) {
    if (all || metric.changed) out.push_back({name, metric.type, metric.value});
    metric.changed = false;
  }
  return out;
}

bool SparkplugNode::Metrics::any_changed() const {
  return std::ranges::any_of(by_name, [](const auto& entry) { return entry.second.changed; });
}

SparkplugNode::SparkplugNode(const SparkplugConfig& config, const Identity& identity, std::uint8_t first_session)
    : config_(config), session_(first_session) {
  const auto text = SparkplugType::text;
  node_.set("Properties/Cell", text, cut_text(identity.cell));
  node_.set("Properties/Instance", text, cut_text(identity.instance));
  node_.set("Properties/Host", text, cut_text(identity.host));
  node_.set("Properties/Software", text, cut_text("cellmirror " + identity.version));
}

void SparkplugNode::see(const CellSummary& summary) {
  using enum SparkplugType;
  node_.set("Health", text, std::string(word(summary.health)));
  const Chosen chosen = choose_devices(summary);
  std::vector<std::string> reasons = chosen.left_out;
  reasons.insert(reasons.end(), summary.reasons.begin(), summary.reasons.end());
  node_.set("Reasons", text, joined(reasons));
  node_.set("Loop/On Time", boolean, summary.loop.on_time);
  node_.set("Loop/Missed", int64, count(summary.loop.missed));
  node_.set("Loop/Faults", int64, count(summary.loop.faults));
  node_.set("Collisions/Touching", int64, count(summary.touching));
  node_.set("Collisions/Nearest Distance", float64,
            summary.nearest ? number(summary.nearest->distance_m) : SparkplugValue());
  node_.set("Alarms/Active", int64, count(summary.alarms.active));
  node_.set("Alarms/Unacknowledged", int64, count(summary.alarms.unacknowledged));
  for (auto& [name, device] : devices_)
    device.gone = std::ranges::none_of(chosen.devices, [&](const RobotSummary* robot) { return robot->id == name; });
  std::erase_if(devices_, [](const auto& entry) { return entry.second.gone && !entry.second.told; });
  for (const RobotSummary* robot : chosen.devices) {
    Device& device = devices_[robot->id];
    device.gone = false;
    device.has_stream = device.has_stream || robot->mirrored;
    device.is_connected = has_current_values(*robot, device.has_stream);
    device.metrics.set("Mirrored", boolean, robot->mirrored);
    device.metrics.set("Data State", text, std::string(word(robot->state)));
    device.metrics.set("Data Age", float64, number(robot->age_s));
  }
}

// Only of robots that a summary has named: it says when one is gone.
void SparkplugNode::see(const RobotState& robot) {
  const auto device = devices_.find(robot.id);
  if (device == devices_.end()) return;
  // A robot of that name that was loaded again may have other joints: the former ones are forgotten.
  if (device->second.metrics.by_name.size() > kMostMetrics) device->second.metrics = Metrics();
  for (const RobotJointState& joint : robot.joints | std::views::take(kMaxJointsPerRobot)) {
    const std::string name = "Joints/" + topic_level(joint.name);
    device->second.metrics.set(name + "/Position", SparkplugType::float64, number(joint.position));
    device->second.metrics.set(name + "/Velocity", SparkplugType::float64, number(joint.velocity));
  }
}

std::string SparkplugNode::topic(std::string_view kind, std::string_view device) const {
  std::string out = fmt::format("spBv1.0/{}/{}/{}", config_.group, kind, config_.edge_node);
  if (!device.empty()) out += "/" + topic_level(device);
  return out;
}

Outgoing SparkplugNode::begin_session(std::int64_t time_ms) {
  if (std::exchange(asked_, false)) ++session_;
  return death(time_ms);
}

std::uint8_t SparkplugNode::asked() {
  asked_ = true;
  return session_;
}

Outgoing SparkplugNode::death(std::int64_t time_ms) const {
  return {.topic = topic("NDEATH"),
          .payload = encode({.time_ms = time_ms, .metrics = {session_metric(session_)}}),
          .qos = 1};
}

void SparkplugNode::bear_again() {
  node_.born = false;
  for (auto& [name, device] : devices_) device.metrics.born = false;
}

void SparkplugNode::disconnected() {
  for (auto& [name, device] : devices_) device.told = false;
}

Outgoing SparkplugNode::message(std::string_view kind, std::string_view device, std::int64_t time_ms,
                                std::vector<SparkplugMetric> metrics) {
  return {.topic = topic(kind, device),
          .payload = encode({.time_ms = time_ms, .seq = seq_++, .metrics = std::move(metrics)})};
}

Outgoing SparkplugNode::node_birth(std::int64_t time_ms) {
  bear_again();  // the devices follow
  node_.born = true;
  seq_ = 0;
  std::vector<SparkplugMetric> metrics{session_metric(session_),
                                       {std::string(kRebirthMetric), SparkplugType::boolean, false}};
  std::ranges::move(node_.take(true), std::back_inserter(metrics));
  return message("NBIRTH", {}, time_ms, std::move(metrics));
}

std::optional<Outgoing> SparkplugNode::next_of(const std::string& name, Device& device, std::int64_t time_ms) {
  Metrics& metrics = device.metrics;
  if (device.gone || !device.is_connected) {
    metrics.born = false;
    if (!std::exchange(device.told, false)) return std::nullopt;
    return message("DDEATH", name, time_ms, {});
  }
  if (!metrics.born) {
    metrics.born = device.told = true;
    return message("DBIRTH", name, time_ms, metrics.take(true));
  }
  if (metrics.any_changed()) return message("DDATA", name, time_ms, metrics.take(false));
  return std::nullopt;
}

// In turn, so that none waits for ever behind others that change all the time. Devices that are gone come first: the id
// of a new one may differ from theirs by case only, and a host would take their DDEATH for its own.
std::optional<Outgoing> SparkplugNode::next_of_devices(std::int64_t time_ms) {
  const auto is_gone = [](const auto& entry) { return entry.second.gone; };
  for (auto gone = std::ranges::find_if(devices_, is_gone); gone != devices_.end();
       gone = std::ranges::find_if(devices_, is_gone)) {
    auto death = next_of(gone->first, gone->second, time_ms);
    devices_.erase(gone);
    if (death) return death;
  }
  auto at = devices_.upper_bound(last_device_);
  for (std::size_t looked = 0; looked < devices_.size(); ++looked, ++at) {
    if (at == devices_.end()) at = devices_.begin();
    auto out = next_of(at->first, at->second, time_ms);
    if (!out) continue;
    last_device_ = at->first;
    return out;
  }
  return std::nullopt;
}

std::optional<Outgoing> SparkplugNode::next(std::int64_t time_ms) {
  if (!node_.born) return node_birth(time_ms);
  if (node_.any_changed()) return message("NDATA", {}, time_ms, node_.take(false));
  return next_of_devices(time_ms);
}

}  // namespace cellmirror::mqtt
