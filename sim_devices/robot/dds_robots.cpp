#include "sim_devices/robot/dds_robots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cellmirror::sim {
namespace {

std::string numbered(std::string text, int number) {
  for (std::size_t at = 0; (at = text.find("{}", at)) != std::string::npos;)
    text.replace(at, 2, std::to_string(number));
  return text;
}

Nanoseconds tick_period(const DdsRobotsConfig& config) {
  return Nanoseconds(std::max<std::int64_t>(std::llround(1e9 / config.rate_hz / config.groups), 1));
}

}  // namespace

DdsRobots::DdsRobots(const DdsRobotsConfig& config, std::unique_ptr<MotionSource> motion)
    : FaultyDevice(config.seed), config_(config), motion_(std::move(motion)), pacer_({}, tick_period(config)) {}

Result<std::unique_ptr<DdsRobots>> DdsRobots::make(const DdsRobotsConfig& config,
                                                   std::unique_ptr<MotionSource> motion) {
  std::unique_ptr<DdsRobots> device(new DdsRobots(config, std::move(motion)));
  const bool own_topics = config.topic.find("{}") != std::string::npos;
  for (int i = 0; i < config.robots; ++i) {
    Robot robot;
    robot.number = config.first_robot + i;
    if (own_topics || i == 0) {
      auto writer = dds::JointStatePublisher::make({.domain = config.domain,
                                                    .interface_address = config.interface_address,
                                                    .topic = numbered(config.topic, robot.number),
                                                    .reliable = config.reliable,
                                                    .security = config.security,
                                                    .partition = config.partition});
      if (!writer) return std::unexpected(writer.error());
      device->writers_.push_back(std::move(*writer));
    }
    robot.writer = device->writers_.size() - 1;
    for (const std::string& name : config.joint_names) {
      robot.state.name.push_back(numbered(config.name_prefix, robot.number) + name);
    }
    const std::size_t joints = config.joint_names.size();
    robot.state.position.resize(joints);
    robot.state.velocity.resize(joints);
    robot.state.effort.resize(joints);
    device->robots_.push_back(std::move(robot));
  }
  device->values_.resize(config.joint_names.size());
  device->counters_.endpoint = fmt::format("domain {} topic {}", config.domain, config.topic);
  device->counters_.first_robot = config.first_robot;
  device->counters_.robots = config.robots;
  device->counters_.samples_of_robot.resize(static_cast<std::size_t>(config.robots));
  return device;
}

void DdsRobots::start(Timestamp now) {
  start_motion(now);
  pacer_ = Pacer(now, tick_period(config_));
}

Timestamp DdsRobots::next() const { return std::min(pacer_.next(), pipeline_.next()); }

void DdsRobots::work(Timestamp now) {
  if (pacer_.due(now)) {
    note_lateness(pacer_.next(), now);
    const auto groups = static_cast<std::uint64_t>(config_.groups);
    for (std::uint64_t i = ticks_ % groups; i < robots_.size(); i += groups) send_sample(robots_[i], now);
    const std::uint64_t missed = pacer_.missed();
    pacer_.advance(now);
    ticks_ += 1 + pacer_.missed() - missed;
  }
  flush(now);
}

void DdsRobots::send_sample(Robot& robot, Timestamp now) {
  if (!pipeline_.schedule().alive(now, {robot.number, 0})) return;
  std::fill(values_.begin(), values_.end(), JointValue{});
  motion_->at(motion_time_s(now), values_);
  pipeline_.schedule().shape(now, robot.number, values_);
  dds::JointState& state = robot.state;
  state.header.stamp = config_.stamped ? dds::ros_time(to_wall_clock_ns(now)) : dds::RosTime{};
  for (std::size_t j = 0; j < values_.size(); ++j) {
    state.position[j] = values_[j].position;
    state.velocity[j] = values_[j].velocity;
    state.effort[j] = values_[j].effort;
  }
  pipeline_.push(now, {now, {robot.number, 0}, MessageKind::sample, {robot.writer, state, {}}});
}

Result<void> DdsRobots::check(const FaultSpec& spec) const {
  if (spec.kind == FaultKind::bus_off) return fail("DDS has no bus-off", "use death");
  if (spec.id) return fail("a JointState has no identifier", "remove id=");
  const bool of_values = spec.kind == FaultKind::frozen || spec.kind == FaultKind::jump || spec.kind == FaultKind::nan;
  if (spec.joint != 0 && !of_values) {
    return fail(fmt::format("{}: one sample carries all joints", name_of(spec.kind)), "remove joint=");
  }
  return {};
}

bool DdsRobots::transmit(const JointStateMessage& message) {
  dds::JointStatePublisher& writer = *writers_[message.writer];
  return message.bytes.empty() ? writer.publish(message.state) : writer.publish_bytes(message.bytes);
}

int DdsRobots::matched_readers() const {
  int fewest = writers_.empty() ? 0 : writers_.front()->matched_readers();
  for (const auto& writer : writers_) fewest = std::min(fewest, writer->matched_readers());
  return fewest;
}

DeviceStatus DdsRobots::status(Timestamp now) const {
  DeviceStatus status = common_status(now);
  status.missed_periods = pacer_.missed();
  status.details.emplace_back("matched_readers", static_cast<std::uint64_t>(std::max(matched_readers(), 0)));
  return status;
}

}  // namespace cellmirror::sim
