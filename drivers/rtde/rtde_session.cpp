#include "drivers/rtde/rtde_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::rtde {

void RtdeSession::begin(Timestamp) {
  splitter_.clear();
  phase_ = Phase::asking_version;
  failed_ = false;
  controller_time_s_ = -1;
  output_.send(version_request(kProtocolVersion));
}

void RtdeSession::receive(std::span<const std::uint8_t> bytes, Timestamp now) {
  if (failed_) return;
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
  reject(fmt::format("a package of unknown type {}", package.type));
}

void RtdeSession::take_version(std::span<const std::uint8_t> payload) {
  const auto yes = decode_accepted(payload);
  if (phase_ != Phase::asking_version || !yes) return reject("an answer about the version that was not expected");
  if (!*yes) return refuse("the controller refuses version 2 of the protocol: update its software");
  phase_ = Phase::asking_outputs;
  output_.send(outputs_request(config_.rate_hz, kVariables));
}

void RtdeSession::take_outputs(std::span<const std::uint8_t> payload) {
  auto answer = decode_outputs(payload);
  if (phase_ != Phase::asking_outputs || !answer) return reject("an answer about outputs that was not expected");
  if (answer->types != kVariableTypes) {
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
  if (phase_ != Phase::running || !data) return reject("a data package of another length or recipe");
  if (!std::isfinite(data->timestamp_s)) return reject("a data package without a time");
  if (data->timestamp_s <= controller_time_s_) return reject("a data package that is not newer than the one before");
  count_lost(data->timestamp_s);
  controller_time_s_ = data->timestamp_s;
  robot_mode_ = data->robot_mode;
  safety_mode_ = data->safety_mode;
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
  }
  if (sample.refused != 0) {
    ++counters_.rejected;
    output_.rejected("a joint position that is not finite");
  }
  ++counters_.samples;
  last_sample_ = now;
  output_.sample(sample);
}

void RtdeSession::count_lost(double timestamp_s) {
  if (controller_time_s_ < 0) return;
  const double periods = (timestamp_s - controller_time_s_) * config_.rate_hz;
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
  output_.rejected(std::string(why));
}

}  // namespace cellmirror::rtde
