#include <fmt/format.h>

#include <algorithm>

#include "config/stream_reader.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr long long kControllerJoints = 6;

RtdeJointConfig read_joint(TableReader& item, const RobotFacts* robot, const RtdeStreamConfig& before) {
  RtdeJointConfig joint;
  const auto reference = read_joint_reference(item, robot);
  if (reference) joint.joint = reference->number;
  item.require("number");
  joint.number = static_cast<std::size_t>(item.integer("number", 1, kControllerJoints).value_or(1) - 1);
  joint.scale = item.number("scale").value_or(1.0);
  if (joint.scale == 0.0) item.error("scale", "scale is 0", "the value would always be the offset");
  joint.offset = item.number("offset").value_or(0.0);
  joint.torque_nm_per_a = item.number("torque_nm_per_a").value_or(0.0);
  item.finish();
  const bool twice = reference && std::ranges::any_of(before.joints, [&](const RtdeJointConfig& other) {
                       return other.joint == joint.joint || other.number == joint.number;
                     });
  if (twice) item.error("joint", fmt::format("the joint {} or its number is given twice", reference->name));
  return joint;
}

}  // namespace

RtdeStreamConfig read_rtde(TableReader& reader, const RobotFacts* robot) {
  constexpr double kHighestRate = 500;  // of the controllers
  RtdeStreamConfig config;
  config.ages = read_ages(reader);
  config.plausibility = read_plausibility(reader, config.ages);
  reader.require("address");
  config.address = reader.text("address").value_or(config.address);
  if (!is_address(config.address)) {
    reader.error("address", fmt::format("\"{}\" is not a numeric address", printable(config.address)),
                 "e.g. 192.168.0.10");
  }
  config.port = static_cast<std::uint16_t>(reader.integer("port", 1, 65535).value_or(config.port));
  config.rate_hz = reader.number("rate_hz", {1.0, kHighestRate}).value_or(config.rate_hz);
  const auto read_any = [](TableReader& item) { static_cast<void>(read_joint(item, nullptr, {})); };
  reader.belongs_to("[[stream.joint]]", keys_read_by(read_any));
  for (TableReader& item : reader.tables("joint", kControllerJoints)) {
    item.belongs_to("[[stream]], above its [[stream.joint]]", reader.known());
    config.joints.push_back(read_joint(item, robot, config));
  }
  if (!reader.has("joint") && robot != nullptr) {
    const auto joints = std::min<std::size_t>(robot->joint_names.size(), kControllerJoints);
    for (std::size_t i = 0; i < joints; ++i) config.joints.push_back({.joint = i, .number = i});
  }
  return config;
}

}  // namespace cellmirror
