#include "ipc/wire/robot_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ipc/wire/little_endian.hpp"
#include "ipc/wire/record_fields.hpp"

namespace cellmirror {
namespace {

using namespace little_endian;
using namespace robot_record_offset;

double age_at(Timestamp time, Timestamp then) {
  if (!then.known()) return std::numeric_limits<double>::quiet_NaN();
  return std::max(0.0, seconds(time - then));  // what came during the tick is 0 old
}

void put_joint(std::span<std::byte> joint, const JointRecord& record) {
  put_name(joint, kJointName, kRecordNameBytes, record.name);
  put(joint, kJointKind, static_cast<std::uint8_t>(record.kind));
  put(joint, kJointState, static_cast<std::uint8_t>(record.state));
  put(joint, kJointPosition, record.position);
  put(joint, kJointVelocity, record.velocity);
  put(joint, kJointEffort, record.effort);
  put(joint, kJointAge, record.age);
  put(joint, kJointSourceAge, record.source_age);
}

Result<DataState> get_state(std::span<const std::byte> bytes, std::size_t offset) {
  const auto state = get<std::uint8_t>(bytes, offset);
  if (state > static_cast<std::uint8_t>(DataState::invalid)) return fail(fmt::format("state {} is unknown", state));
  return static_cast<DataState>(state);
}

Result<JointRecord> get_joint(std::span<const std::byte> joint) {
  JointRecord record;
  auto name = get_text(joint, kJointName, kRecordNameBytes);
  if (!name) return std::unexpected(name.error());
  record.name = std::move(*name);
  const auto kind = get<std::uint8_t>(joint, kJointKind);
  if (kind > static_cast<std::uint8_t>(JointKind::prismatic))
    return fail(fmt::format("joint kind {} is unknown", kind));
  record.kind = static_cast<JointKind>(kind);
  const auto state = get_state(joint, kJointState);
  if (!state) return std::unexpected(state.error());
  record.state = *state;
  if (!all_zero(joint.subspan(kJointReserved, kJointPosition - kJointReserved))) {
    return fail("reserved bytes of a joint are not 0");
  }
  record.position = get<double>(joint, kJointPosition);
  record.velocity = get<double>(joint, kJointVelocity);
  record.effort = get<double>(joint, kJointEffort);
  record.age = get<double>(joint, kJointAge);
  record.source_age = get<double>(joint, kJointSourceAge);
  return record;
}

// All of the payload before the joints; their number goes to `joint_count`.
Result<RobotRecord> get_robot(std::span<const std::byte> bytes, std::size_t& joint_count) {
  RobotRecord record;
  auto id = get_text(bytes, kId, kRecordNameBytes);
  if (!id) return std::unexpected(id.error());
  record.id = std::move(*id);
  const auto online = get<std::uint8_t>(bytes, kOnline);
  if (online > 1) return fail(fmt::format("online flag {}, it is 0 or 1", online));
  record.online = online == 1;
  const auto state = get_state(bytes, kState);
  if (!state) return std::unexpected(state.error());
  record.state = *state;
  if (get<std::uint32_t>(bytes, kReserved) != 0) return fail("reserved bytes of the robot are not 0");
  record.sample_sequence = get<std::uint64_t>(bytes, kSampleSequence);
  record.base_tcp = get_pose(bytes, kBaseTcp);
  record.world_tcp = get_pose(bytes, kWorldTcp);
  joint_count = get<std::uint16_t>(bytes, kJointCount);
  if (joint_count > kMaxJointsPerRobot || bytes.size() != kJoints + joint_count * kJointBytes) {
    return fail(fmt::format("{} joints do not fit a record of {} bytes", joint_count, bytes.size()));
  }
  return record;
}

// Readers of the record know the states up to `invalid`, which is what the later ones are to them: the newest value was
// not taken.
DataState recorded(DataState state) { return std::min(state, DataState::invalid); }

}  // namespace

RobotRecord robot_record_of(const RobotState& robot, Timestamp time) {
  RobotRecord record;
  record.header.time_ns = time.ns;
  record.id = robot.id;
  record.online = robot.online;
  record.state = recorded(robot.state);
  record.sample_sequence = robot.sequence;
  record.base_tcp = pose_record_of(robot.X_BT);
  record.world_tcp = pose_record_of(robot.X_WT);
  record.joints.reserve(robot.joints.size());
  for (const RobotJointState& joint : robot.joints) {
    record.joints.push_back({joint.name, joint.kind, recorded(joint.state), joint.position, joint.velocity,
                             joint.effort, age_at(time, joint.receive_time), age_at(time, joint.source_time)});
  }
  return record;
}

Result<std::size_t> encode_robot_record(const RobotRecord& record, std::span<std::byte> bytes) {
  if (record.joints.size() > kMaxJointsPerRobot) {
    return fail(
        fmt::format("robot {} has {} joints, a record holds {}", record.id, record.joints.size(), kMaxJointsPerRobot));
  }
  const std::size_t length = kJoints + record.joints.size() * kJointBytes;
  if (bytes.size() < length) return fail(fmt::format("a robot record of {} bytes into {}", length, bytes.size()));
  const auto out = bytes.first(length);
  std::fill(out.begin(), out.end(), std::byte{0});
  RecordHeader header = record.header;
  header.kind = RecordKind::robot_parameters;
  encode_record_header(header, out);
  put_name(out, kId, kRecordNameBytes, record.id);
  put(out, kOnline, static_cast<std::uint8_t>(record.online ? 1 : 0));
  put(out, kState, static_cast<std::uint8_t>(record.state));
  put(out, kJointCount, static_cast<std::uint16_t>(record.joints.size()));
  put(out, kSampleSequence, record.sample_sequence);
  put_pose(out, kBaseTcp, record.base_tcp);
  put_pose(out, kWorldTcp, record.world_tcp);
  for (std::size_t i = 0; i < record.joints.size(); ++i) {
    put_joint(out.subspan(kJoints + i * kJointBytes, kJointBytes), record.joints[i]);
  }
  return length;
}

Result<RobotRecord> decode_robot_record(std::span<const std::byte> bytes) {
  const auto header = decode_record_header(bytes);
  if (!header) return std::unexpected(header.error());
  if (header->kind != RecordKind::robot_parameters) {
    return fail(fmt::format("a record of kind {}, not of robot parameters", static_cast<int>(header->kind)));
  }
  if (bytes.size() < kJoints)
    return fail(fmt::format("a robot record of {} bytes; it has {} at least", bytes.size(), kJoints));
  std::size_t joint_count = 0;
  auto record = get_robot(bytes, joint_count);
  if (!record) return record;
  record->header = *header;
  record->joints.reserve(joint_count);
  for (std::size_t i = 0; i < joint_count; ++i) {
    auto joint = get_joint(bytes.subspan(kJoints + i * kJointBytes, kJointBytes));
    if (!joint) return fail(fmt::format("joint {}: {}", i, joint.error().what));
    record->joints.push_back(std::move(*joint));
  }
  return record;
}

}  // namespace cellmirror
