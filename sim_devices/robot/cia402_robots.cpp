#include "sim_devices/robot/cia402_robots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/nmt.hpp"
#include "drivers/can/cia402/drive_objects.hpp"

namespace cellmirror::sim {
namespace {

template <class Integer>
Integer rounded(double value) {
  constexpr double kLeast = std::numeric_limits<Integer>::min();
  constexpr double kMost = std::numeric_limits<Integer>::max();
  return static_cast<Integer>(std::llround(std::clamp(std::isfinite(value) ? value : 0.0, kLeast, kMost)));
}

can::Cia402DriveConfig drive_config(const Cia402RobotsConfig& config, std::uint8_t node) {
  can::Cia402DriveConfig drive;
  drive.node_id = node;
  drive.heartbeat_ms = config.heartbeat_ms;
  drive.self_starting = config.self_starting;
  drive.follows_targets = config.follows_targets;
  TpdoConfig position;
  position.number = 1;
  position.transmission_type = config.on_sync ? 1 : 255;
  position.event_timer_ms = config.on_sync ? std::uint16_t{0} : config.sample_period_ms;
  position.entries = {{can::kStatusword.index, 0, 16}, {can::kPositionActual.index, 0, 32}};
  drive.tpdos = {position};
  if (config.with_velocity) {
    TpdoConfig velocity = position;
    velocity.number = 2;
    velocity.entries = {{can::kVelocityActual.index, 0, 32}, {can::kTorqueActual.index, 0, 16}};
    drive.tpdos.push_back(velocity);
  }
  return drive;
}

// Kind of a drive's message by the predefined connection set.
MessageKind kind_of(const CanFrame& frame, std::uint8_t node) {
  if (frame.id == can::kHeartbeatBase + node) return frame.data[0] == 0 ? MessageKind::boot_up : MessageKind::heartbeat;
  if (frame.id == can::kEmcyBase + node) return MessageKind::emergency;
  if (frame.id == can::kSdoResponseBase + node) return MessageKind::sdo;
  return MessageKind::sample;
}

Nanoseconds or_idle(Nanoseconds period) { return period.count() > 0 ? period : Nanoseconds(1'000'000'000); }

}  // namespace

Cia402Robots::Node::Node(Cia402Robots& robots, Source where, const can::Cia402DriveConfig& config)
    : owner(robots), source(where), drive(config, *this) {}

void Cia402Robots::Node::send(const CanFrame& frame) {
  owner.pipeline_.push(owner.now_, {owner.now_, source, kind_of(frame, drive.node_id()), frame});
}

Cia402Robots::Cia402Robots(const Cia402RobotsConfig& config, std::shared_ptr<const MotionSource> motion,
                           std::unique_ptr<CanChannel> channel)
    : FaultyDevice(config.seed),
      config_(config),
      motion_(std::move(motion)),
      channel_(std::move(channel)),
      ticks_({}, std::chrono::milliseconds(std::max<std::uint16_t>(config.sample_period_ms, 1))),
      sync_({}, or_idle(config.sync_period)) {
  for (std::size_t robot = 0; robot < config.nodes.size(); ++robot) {
    const auto& ids = config.nodes[robot];
    for (std::size_t joint = 0; joint < ids.size(); ++joint) {
      const Source source{config.first_robot + static_cast<int>(robot), static_cast<int>(joint) + 1};
      nodes_.push_back(std::make_unique<Node>(*this, source, drive_config(config, ids[joint])));
    }
  }
  counters_.endpoint = config.endpoint;
  counters_.first_robot = config.first_robot;
  counters_.robots = static_cast<int>(config.nodes.size());
  counters_.samples_of_robot.resize(config.nodes.size());
  inbox_.reserve(kMostInbox);
}

void Cia402Robots::start(Timestamp now) {
  now_ = now;
  start_motion(now);
  ticks_ = Pacer(now, ticks_.period());
  sync_ = Pacer(now, sync_.period());
  update_life(now);
}

Timestamp Cia402Robots::next() const {
  Timestamp next = std::min(pipeline_.next(), pipeline_.schedule().next_life_change(now_));
  if (any_needs_ticks_) next = std::min(next, ticks_.next());
  if (config_.sync_period.count() > 0) next = std::min(next, sync_.next());
  for (const auto& node : nodes_) {
    if (const Timestamp due = node->drive.next_due(); due.known()) next = std::min(next, due);
  }
  return next;
}

void Cia402Robots::work(Timestamp now) {
  now_ = now;
  channel_status_ = channel_->status();
  update_life(now);
  for (const ReceivedCanFrame& received : inbox_) hear(received.frame, now);
  inbox_.clear();
  if (config_.sync_period.count() > 0 && sync_.due(now)) send_sync(now);
  advance(now);
  flush(now);
}

void Cia402Robots::wait_until(Timestamp t) {
  const SystemClock clock;
  ReceivedCanFrame received;
  const Nanoseconds left = t - clock.now();
  if (left.count() <= 0) return;
  CanReceive got = channel_->receive(received, left);
  while (got == CanReceive::frame) {
    inbox_.push_back(received);
    if (inbox_.size() >= kMostInbox) return;
    got = channel_->receive(received, Nanoseconds(0));
  }
  // A channel may wake a little early, and one that is down may not wait at all.
  if (inbox_.empty()) sleep_until(t);
}

void Cia402Robots::update_life(Timestamp now) {
  for (const auto& node : nodes_) {
    const bool alive = pipeline_.schedule().alive(now, node->source);
    if (alive == node->drive.is_powered()) continue;
    if (alive) {
      measure(*node, now);
      node->drive.power_on(now);
      note_mapping(*node);
    } else {
      node->drive.power_off();
    }
  }
}

void Cia402Robots::hear(const CanFrame& frame, Timestamp now) {
  ++counters_.received;
  const bool to_all = frame.id == can::kNmtCobId || frame.id == can::kSyncCobId;
  const bool request = frame.id > can::kSdoRequestBase && frame.id <= can::kSdoRequestBase + can::kMaxNodeId;
  // Other nodes' heartbeats, SDO answers and emergencies concern no drive; an RPDO may have any other identifier.
  const bool of_others = frame.id > can::kHeartbeatBase || (frame.id > can::kEmcyBase && frame.id < can::kTimeCobId) ||
                         (frame.id > can::kSdoResponseBase && frame.id < can::kSdoRequestBase);
  if (of_others && !frame.extended) return;
  for (const auto& node : nodes_) {
    can::Cia402Drive& drive = node->drive;
    if (request && frame.id != can::kSdoRequestBase + drive.node_id()) continue;
    if (to_all || request) measure(*node, now);
    drive.receive(frame, now);
    if (to_all || request) note_mapping(*node);
  }
}

void Cia402Robots::note_mapping(Node& node) {
  node.needs_ticks = sends_on_change_only(node.drive);
  any_needs_ticks_ = any_needs_ticks_ || node.needs_ticks;
}

void Cia402Robots::measure(Node& node, Timestamp now) {
  if (config_.follows_targets) return;
  if (values_time_ != now || values_robot_ != node.source.robot) {
    const auto robot = static_cast<std::size_t>(node.source.robot - config_.first_robot);
    values_.assign(config_.nodes[robot].size(), JointValue{});
    motion_->at(motion_time_s(now), values_);
    values_time_ = now;
    values_robot_ = node.source.robot;
  }
  const auto joint = static_cast<std::size_t>(node.source.joint - 1);
  JointValue value = values_[joint];
  pipeline_.schedule().shape(now, node.source, value);
  const double scale = config_.increments_per_unit[joint % config_.increments_per_unit.size()];
  node.drive.set_actual(rounded<std::int32_t>(value.position * scale), rounded<std::int32_t>(value.velocity * scale),
                        rounded<std::int16_t>(value.effort), now);
}

void Cia402Robots::advance(Timestamp now) {
  const bool tick = any_needs_ticks_ && ticks_.due(now);
  if (tick) ticks_.advance(now);
  for (const auto& node : nodes_) {
    const Timestamp due = node->drive.next_due();
    const bool timed = due.known() && due <= now;
    if (!timed && !(tick && node->needs_ticks)) continue;
    if (timed) note_lateness(due, now);
    measure(*node, now);
    node->drive.advance(now);
  }
}

void Cia402Robots::send_sync(Timestamp now) {
  note_lateness(sync_.next(), now);
  sync_.advance(now);
  const CanFrame sync = can::encode_sync();
  pipeline_.push(now, {now, {}, MessageKind::sync, sync});
  for (const auto& node : nodes_) {
    measure(*node, now);
    node->drive.receive(sync, now);
  }
}

bool Cia402Robots::sends_on_change_only(const can::Cia402Drive& drive) {
  for (std::uint16_t index = 0x1800; index < 0x1804; ++index) {
    const auto cob_id = drive.objects().integer({index, 1});
    const auto type = drive.objects().integer({index, 2});
    const auto timer = drive.objects().integer({index, 5});
    if (cob_id && (*cob_id & can::kCobIdInvalid) == 0 && type && *type >= 254 && timer.value_or(0) == 0) return true;
  }
  return false;
}

Result<void> Cia402Robots::check(const FaultSpec& spec) const {
  if (spec.kind == FaultKind::nan) return fail("an integer object cannot be NaN", "use jump or corrupt");
  return {};
}

Result<std::string> Cia402Robots::send_emergency(const SendEmergency& command, Timestamp now) {
  now_ = now;
  int sent = 0;
  for (const auto& node : nodes_) {
    const bool meant = (command.source.robot == 0 || command.source.robot == node->source.robot) &&
                       (command.source.joint == 0 || command.source.joint == node->source.joint);
    if (!meant || !node->drive.is_powered()) continue;
    if (command.code == 0) {
      node->drive.clear_fault(now);
      if (config_.self_starting) node->drive.set_state(can::Cia402State::operation_enabled, now);
    } else {
      node->drive.raise_fault(command.code, command.error_register, now);
    }
    ++sent;
  }
  if (sent == 0) return fail("no living drive of that robot and joint", "robot= and joint= count from 1");
  return std::to_string(sent) + " drives";
}

DeviceStatus Cia402Robots::status(Timestamp now) const {
  DeviceStatus status = common_status(now);
  status.missed_periods = sync_.missed();
  status.details.emplace_back("channel_received", channel_status_.received);
  status.details.emplace_back("channel_malformed", channel_status_.malformed);
  status.details.emplace_back("channel_receive_dropped", channel_status_.receive_dropped);
  std::uint64_t operational = 0;
  for (const auto& node : nodes_) operational += node->drive.nmt_state() == can::NmtState::operational ? 1U : 0U;
  status.details.emplace_back("nodes", nodes_.size());
  status.details.emplace_back("nodes_operational", operational);
  return status;
}

}  // namespace cellmirror::sim
