#include "drivers/dds/joint_state_router.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {
constexpr std::size_t kMaxPublishers = 1024;  // remembered at a time; more can only be hostile
}

Result<std::unique_ptr<RobotFeed>> RobotFeed::make(const std::vector<DdsJointConfig>& joints,
                                                   Nanoseconds conflict_window) {
  if (joints.empty()) return fail("a DDS stream has no joints", "map at least one ROS 2 joint name to a joint");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const DdsJointConfig& joint = joints[i];
    if (joint.ros_name.empty()) return fail(fmt::format("the ROS 2 name of joint {} is empty", joint.joint));
    if (joint.joint >= kMaxJointsPerRobot) {
      return fail(fmt::format("'{}' is mapped to joint {}, but a robot has at most {}", joint.ros_name, joint.joint,
                              kMaxJointsPerRobot));
    }
    if (!std::isfinite(joint.scale) || joint.scale == 0.0 || !std::isfinite(joint.offset)) {
      return fail(fmt::format("scale or offset of '{}' is not usable", joint.ros_name),
                  "give a finite scale other than zero and a finite offset");
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (joints[k].ros_name == joint.ros_name) return fail(fmt::format("'{}' is mapped twice", joint.ros_name));
      if (joints[k].joint == joint.joint) {
        return fail(fmt::format("'{}' and '{}' are mapped to the same joint {}", joints[k].ros_name, joint.ros_name,
                                joint.joint));
      }
    }
  }
  return std::unique_ptr<RobotFeed>(new RobotFeed(joints, conflict_window));
}

std::string_view RobotFeed::ros_name(std::size_t joint) const {
  const auto found = std::ranges::find(joints_, joint, &DdsJointConfig::joint);
  return found == joints_.end() ? std::string_view() : std::string_view(found->ros_name);
}

void RobotFeed::publish() {
  newest_.counters = counters_;
  newest_.rate = rate_;
  newest_.last_receive_time = last_receive_time_;
  published_.write(newest_);
}

bool RobotFeed::is_in_conflict(std::size_t index, const MessageOrigin& origin) {
  SenderConflict& senders = senders_[index];
  const Timestamp now = sample_.receive_time;
  const std::size_t joint = joints_[index].joint;
  if (!senders.take(origin.publisher, origin.guid, now)) {
    if (newest_.conflict_joint == joint) newest_.last_conflict = {};
    return false;
  }
  if (!newest_.last_conflict.known())
    note_error(fmt::format("two publishers name joint '{}': {} and {}", joints_[index].ros_name, text(senders.other()),
                           text(senders.newest())));
  sample_.conflict |= 1U << joint;
  ++counters_.conflicts;
  newest_.last_conflict = now;
  newest_.conflict_joint = joint;
  newest_.publisher = senders.newest();
  newest_.other_publisher = senders.other();
  return true;
}

void RobotFeed::begin(Timestamp receive_time, Timestamp source_time) {
  sample_ = JointSample{};
  sample_.receive_time = receive_time;
  sample_.source_time = source_time;
}

void RobotFeed::take(const DdsJointConfig& joint, const JointStateView& message, std::size_t i) {
  const std::uint32_t bit = 1U << joint.joint;
  const double position = message.position[i] * joint.scale + joint.offset;
  if (!std::isfinite(position)) return refuse(joint, "its position is not finite");
  sample_.present |= bit;
  sample_.position[joint.joint] = position;
  sample_.velocity[joint.joint] = derivative(joint, message.velocity, i, joint.scale, "velocity");
  sample_.effort[joint.joint] = derivative(joint, message.effort, i, 1.0 / joint.scale, "effort");
}

// Velocities scale like positions; efforts inversely, so that the power stays the same.
double RobotFeed::derivative(const DdsJointConfig& joint, const DoubleSequenceView& values, std::size_t i,
                             double factor, std::string_view what) {
  if (values.empty()) return 0.0;
  const double value = values[i] * factor;  // which may be infinite although both are finite
  if (std::isfinite(value)) return value;
  if (std::isnan(value)) {
    ++counters_.unknown;
  } else {
    ++counters_.rejected;
    note_error(fmt::format("the {} of joint '{}' is infinite: taken as unknown", what, joint.ros_name));
  }
  return 0.0;
}

void RobotFeed::refuse(const DdsJointConfig& joint, std::string_view why) {
  const std::uint32_t bit = 1U << joint.joint;
  sample_.present &= ~bit;
  sample_.refused |= bit;
  sample_.position[joint.joint] = sample_.velocity[joint.joint] = sample_.effort[joint.joint] = 0.0;
  ++counters_.rejected;
  note_error(fmt::format("joint '{}' refused: {}", joint.ros_name, why));
}

void RobotFeed::note_error(std::string text) {
  if (!last_errors_.empty() && last_errors_.back() == text) return;
  if (last_errors_.size() == kKeptErrors) last_errors_.erase(last_errors_.begin());
  last_errors_.push_back(std::move(text));
  published_errors_.writable() = last_errors_;
  published_errors_.publish();
}

void RobotFeed::finish() {
  touched_ = false;
  sample_.sequence = ++sequence_;
  last_receive_time_ = sample_.receive_time;
  rate_.count(sample_.receive_time);
  // Published before the sink has the sample, so that a status never counts less than has arrived there.
  ++counters_.received;
  publish();
  if (sink_->push(sample_)) return;
  --counters_.received;
  ++counters_.sink_full;
  publish();
}

void JointStateRouter::add(RobotFeed& feed, JointSampleSink& sink) {
  CELLMIRROR_EXPECTS(std::find(feeds_.begin(), feeds_.end(), &feed) == feeds_.end());
  feed.sink_ = &sink;
  feeds_.push_back(&feed);
  touched_.reserve(feeds_.size());
  rebuild();
}

void JointStateRouter::remove(RobotFeed& feed) {
  std::erase(feeds_, &feed);
  feed.sink_ = nullptr;
  rebuild();
}

void JointStateRouter::rebuild() {
  names_.clear();
  for (RobotFeed* feed : feeds_) {
    for (std::size_t i = 0; i < feed->joints_.size(); ++i) {
      names_[feed->joints_[i].ros_name].targets.push_back({feed, i});
    }
  }
}

void JointStateRouter::accept(std::span<const std::byte> payload, Timestamp receive_time, MessageOrigin origin) {
  ++message_;
  const std::uint64_t missing = take_missing(origin);
  if (const CdrFault fault = decode(payload, view_); fault != CdrFault::none) {
    if (!feeds_.empty() && feeds_.front()->payloads_) feeds_.front()->payloads_->take(payload, receive_time);
    return refuse_message(fmt::format("a sample of {} bytes is no JointState: {}", payload.size(), words(fault)));
  }
  touched_.clear();
  for (const std::string_view name : view_.name) {
    const auto known = names_.find(name);
    if (known == names_.end()) continue;
    for (const Target& target : known->second.targets) touch(*target.feed, receive_time);
  }
  give_payload(payload, receive_time);
  for (RobotFeed* feed : touched_) feed->counters_.lost += missing;
  if (lengths_fit(view_)) {
    route_values(origin);
  } else {
    refuse_lengths();
  }
  if (touched_.empty()) return;
  if (const auto publisher = publishers_.find(origin.publisher); publisher != publishers_.end()) {
    publisher->second.feeds_us = true;
    publisher->second.missing = 0;
  }
}

// Once, however many robots share it.
void JointStateRouter::give_payload(std::span<const std::byte> payload, Timestamp receive_time) const {
  const auto first = std::ranges::find_if(feeds_, [](const RobotFeed* feed) { return feed->touched_; });
  if (first != feeds_.end() && (*first)->payloads_) (*first)->payloads_->take(payload, receive_time);
}

void JointStateRouter::refuse_too_long(std::size_t bytes, std::size_t most, MessageOrigin origin) {
  ++message_;
  static_cast<void>(take_missing(origin));
  refuse_message(fmt::format("a sample of {} bytes is refused: at most {} are taken", bytes, most));
}

void JointStateRouter::refuse_message(const std::string& why) {
  for (RobotFeed* feed : feeds_) {
    ++feed->counters_.rejected;
    ++feed->counters_.malformed;
    feed->note_error(why);
    feed->publish();
  }
}

void JointStateRouter::touch(RobotFeed& feed, Timestamp receive_time) {
  if (feed.touched_) return;
  feed.touched_ = true;
  touched_.push_back(&feed);
  const auto wall_ns = wall_clock_ns(view_.stamp);
  if (!wall_ns && view_.stamp != RosTime{}) ++feed.counters_.bad_stamps;
  feed.newest_.stamp_age.reset();
  if (wall_ns) feed.newest_.stamp_age = Nanoseconds(to_wall_clock_ns(receive_time) - *wall_ns);
  feed.begin(receive_time, wall_ns ? from_wall_clock_ns(*wall_ns) : Timestamp{});
}

bool JointStateRouter::lengths_fit(const JointStateView& message) const {
  const std::size_t n = message.name.size();
  return message.position.size() == n && (message.velocity.empty() || message.velocity.size() == n) &&
         (message.effort.empty() || message.effort.size() == n);
}

void JointStateRouter::route_values(const MessageOrigin& origin) {
  if (touched_.empty()) return;
  for (std::size_t i = 0; i < view_.name.size(); ++i) {
    const auto known = names_.find(view_.name[i]);
    if (known == names_.end()) continue;
    const bool again = std::exchange(known->second.message, message_) == message_;
    for (const Target& target : known->second.targets) {
      const DdsJointConfig& joint = target.feed->joints_[target.joint];
      if (again) {
        target.feed->refuse(joint, "it occurs twice in one message");
      } else if (!target.feed->is_in_conflict(target.joint, origin)) {
        target.feed->take(joint, view_, i);
      }
    }
  }
  for (RobotFeed* feed : touched_) feed->finish();
}

void JointStateRouter::refuse_lengths() {
  for (RobotFeed* feed : touched_) {
    feed->touched_ = false;
    ++feed->counters_.rejected;
    ++feed->counters_.wrong_length;
    feed->note_error(fmt::format("message refused: {} names, but {} positions, {} velocities, {} efforts",
                                 view_.name.size(), view_.position.size(), view_.velocity.size(), view_.effort.size()));
    feed->publish();
  }
}

// What is missing before this message in its publisher's sequence, as far as no robot has counted it yet.
std::uint64_t JointStateRouter::take_missing(MessageOrigin origin) {
  if (origin.publisher == 0) return 0;
  if (publishers_.size() >= kMaxPublishers && !publishers_.contains(origin.publisher)) publishers_.clear();
  auto [entry, is_new] = publishers_.try_emplace(origin.publisher, Publisher{.last_sequence = origin.sequence});
  Publisher& publisher = entry->second;
  if (is_new) return 0;
  if (publisher.feeds_us && origin.sequence > publisher.last_sequence + 1) {
    publisher.missing += origin.sequence - publisher.last_sequence - 1;
  }
  publisher.last_sequence = std::max(publisher.last_sequence, origin.sequence);
  return publisher.missing;
}

void JointStateRouter::forget(std::uint64_t publisher) { publishers_.erase(publisher); }

}  // namespace cellmirror::dds
