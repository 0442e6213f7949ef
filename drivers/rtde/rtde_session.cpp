#include "drivers/rtde/rtde_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::rtde {

namespace {

// Bound for the advance of the controller's clock over ours between two packages.
constexpr double kMostAhead = 5.0;  // s
constexpr unsigned kTimeBeginsAnewAfter = 3;
constexpr unsigned kMostUnreadable = 20;

// Effort in Nm, in the joint's direction; 0: unknown.
double effort_of(const RtdeJointConfig& joint, const RobotData& data) {
  if (!data.has_all) return 0.0;
  const double moment =
      joint.torque_nm_per_a != 0.0 ? joint.torque_nm_per_a * data.current[joint.number] : data.moment[joint.number];
  return std::isfinite(moment) ? std::copysign(1.0, joint.scale) * moment : 0.0;
}

}  // namespace

void RtdeSession::begin(Timestamp now) {
  now_ = now;
  splitter_.clear();
  phase_ = Phase::asking_version;
  failed_ = false;
  asked_for_all_ = true;
  controller_time_s_.reset();
  other_time_s_.reset();
  others_ = 0;
  unreadable_ = 0;
  speed_scaling_.reset();
  runtime_state_.reset();
  output_.send(version_request(kProtocolVersion));
}

void RtdeSession::receive(std::span<const std::uint8_t> bytes, Timestamp now) {
  if (failed_) return;
  now_ = now;
  splitter_.add(bytes);
  while (!failed_) {
    const auto package = splitter_.next();
    if (!package) break;
    take(*package, now);
  }
  if (splitter_.broken()) {
    reject("the bytes are not RTDE");
    failed_ = true;
  }
}

void RtdeSession::take(const Package& package, Timestamp now) {
  switch (static_cast<PackageType>(package.type)) {
    case PackageType::version:
      return take_version(package.payload);
    case PackageType::outputs:
      return take_outputs(package.payload);
    case PackageType::start:
      return take_start(package.payload);
    case PackageType::data:
      return take_data(package.payload, now);
    case PackageType::text:
      return output_.message(decode_text(package.payload));
  }
  reject_package(fmt::format("a package of unknown type {}", package.type));
}

void RtdeSession::reject_package(std::string_view why) {
  reject(why);
  if (++unreadable_ < kMostUnreadable) return;
  reject(fmt::format("{} packages in a row cannot be read, the last was {}", unreadable_, why));
  failed_ = true;
}

void RtdeSession::take_version(std::span<const std::uint8_t> payload) {
  const auto yes = decode_accepted(payload);
  if (phase_ != Phase::asking_version || !yes) return reject("an answer about the version that was not expected");
  if (!*yes) return refuse("the controller refuses version 2 of the protocol: update its software");
  phase_ = Phase::asking_outputs;
  output_.send(outputs_request(config_.rate_hz, kAllVariables));
}

void RtdeSession::take_outputs(std::span<const std::uint8_t> payload) {
  auto answer = decode_outputs(payload);
  if (phase_ != Phase::asking_outputs || !answer) return reject("an answer about outputs that was not expected");
  if (asked_for_all_ && answer->types != kAllVariableTypes) {
    // An older controller: request only the variables that every controller has.
    asked_for_all_ = false;
    output_.send(outputs_request(config_.rate_hz, kVariables));
    return;
  }
  if (!asked_for_all_ && answer->types != kVariableTypes) {
    return refuse(fmt::format("the controller gives {} for {}", printable(answer->types.substr(0, 80)), kVariables));
  }
  recipe_ = answer->recipe;
  phase_ = Phase::starting;
  output_.send(start_request());
}

void RtdeSession::take_start(std::span<const std::uint8_t> payload) {
  const auto yes = decode_accepted(payload);
  if (phase_ != Phase::starting || !yes) return reject("an answer about the start that was not expected");
  if (!*yes) return refuse("the controller refuses to start the data");
  phase_ = Phase::running;
}

void RtdeSession::take_data(std::span<const std::uint8_t> payload, Timestamp now) {
  output_.data(payload, now);
  const auto data = decode_data(payload, recipe_);
  if (phase_ != Phase::running || !data) return reject_package("a data package of another length or recipe");
  unreadable_ = 0;
  if (!std::isfinite(data->timestamp_s)) return reject("a data package without a time");
  if (!is_in_time(data->timestamp_s, now)) return;
  count_lost(data->timestamp_s);
  controller_time_s_ = data->timestamp_s;
  other_time_s_.reset();
  others_ = 0;
  note_sender(*data);
  JointSample sample;
  sample.receive_time = now;
  sample.sequence = counters_.samples + 1;
  for (const RtdeJointConfig& joint : config_.joints) {
    const double q = joint.scale * data->q[joint.number] + joint.offset;
    const double qd = joint.scale * data->qd[joint.number];
    const auto bit = 1U << joint.joint;
    if (!std::isfinite(q)) {
      sample.refused |= bit;
      continue;
    }
    sample.present |= bit;
    sample.position[joint.joint] = q;
    sample.velocity[joint.joint] = std::isfinite(qd) ? qd : 0.0;
    sample.effort[joint.joint] = effort_of(joint, *data);
  }
  if (sample.refused != 0) {
    ++counters_.rejected;
    output_.rejected("a joint position that is not finite");
  }
  ++counters_.samples;
  last_sample_ = now;
  last_refused_ = {};
  output_.sample(sample);
}

void RtdeSession::note_sender(const RobotData& data) {
  robot_mode_ = data.robot_mode;
  safety_mode_ = data.safety_mode;
  if (!data.has_all) return;
  if (std::isfinite(data.speed_scaling)) speed_scaling_ = data.speed_scaling;
  runtime_state_ = data.runtime_state;
}

bool RtdeSession::is_in_time(double timestamp_s, Timestamp now) {
  if (!controller_time_s_) return true;
  const double ahead = timestamp_s - *controller_time_s_;
  const double elapsed = last_sample_.known() ? seconds(now - last_sample_) : 0.0;
  const bool too_old = ahead <= 0;
  if (!too_old && ahead <= elapsed + kMostAhead) return true;
  const bool follows = other_time_s_ && timestamp_s > *other_time_s_ && timestamp_s - *other_time_s_ <= kMostAhead;
  others_ = follows ? others_ + 1 : 1;
  other_time_s_ = timestamp_s;
  if (others_ >= kTimeBeginsAnewAfter) {
    controller_time_s_.reset();  // so that the change is not counted as lost packages
    output_.message(fmt::format("the controller's time has changed by {:.3f} s", ahead));
    return true;
  }
  reject(too_old ? std::string("a data package that is not newer than the one before")
                 : fmt::format("a data package {:.3f} s ahead of the one before", ahead));
  return false;
}

void RtdeSession::count_lost(double timestamp_s) {
  if (!controller_time_s_) return;
  const double periods = (timestamp_s - *controller_time_s_) * config_.rate_hz;
  constexpr double kMost = 1e6;
  if (periods > 1.5) counters_.lost += static_cast<std::uint64_t>(std::llround(std::min(periods, kMost))) - 1;
}

void RtdeSession::refuse(std::string_view why) {
  phase_ = Phase::refused;
  failed_ = true;
  reject(why);
}

void RtdeSession::reject(std::string_view why) {
  ++counters_.rejected;
  last_refused_ = now_;
  why_refused_ = why;
  output_.rejected(std::string(why));
}

}  // namespace cellmirror::rtde
