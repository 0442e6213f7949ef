// The robot-parameter record: one robot at one tick (SENSOR channel, `ROBOT <id> send_on`).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ipc/wire/pose_fields.hpp"
#include "ipc/wire/record.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror {

namespace robot_record_offset {
// From the start of the record.
inline constexpr std::size_t kId = 40;               // char[64]
inline constexpr std::size_t kOnline = 104;          // u8, 0 or 1
inline constexpr std::size_t kState = 105;           // u8
inline constexpr std::size_t kJointCount = 106;      // u16
inline constexpr std::size_t kReserved = 108;        // u32, 0
inline constexpr std::size_t kSampleSequence = 112;  // u64
inline constexpr std::size_t kBaseTcp = 120;         // pose
inline constexpr std::size_t kWorldTcp = 176;        // pose
inline constexpr std::size_t kJoints = 232;          // first joint
// From the start of a joint.
inline constexpr std::size_t kJointName = 0;         // char[64]
inline constexpr std::size_t kJointKind = 64;        // u8
inline constexpr std::size_t kJointState = 65;       // u8
inline constexpr std::size_t kJointReserved = 66;    // 6 bytes, 0
inline constexpr std::size_t kJointPosition = 72;    // f64
inline constexpr std::size_t kJointVelocity = 80;    // f64
inline constexpr std::size_t kJointEffort = 88;      // f64
inline constexpr std::size_t kJointAge = 96;         // f64
inline constexpr std::size_t kJointSourceAge = 104;  // f64
inline constexpr std::size_t kJointBytes = 112;
}  // namespace robot_record_offset

inline constexpr std::size_t kMaxRobotRecordBytes =
    robot_record_offset::kJoints + kMaxJointsPerRobot * robot_record_offset::kJointBytes;
static_assert(kMaxRobotRecordBytes <= kMaxRecordBytes, "a robot fits in one record");

struct JointRecord {
  std::string name;
  JointKind kind = JointKind::revolute;
  DataState state = DataState::none;
  double position = 0;    // rad or m
  double velocity = 0;    // rad/s or m/s
  double effort = 0;      // Nm or N
  double age = 0;         // s since the value was received, at the record's time; NaN where nothing was received
  double source_age = 0;  // s since the source's own stamp; NaN where it has none
};

struct RobotRecord {
  RecordHeader header;
  std::string id;
  bool online = false;
  DataState state = DataState::none;
  std::uint64_t sample_sequence = 0;
  PoseRecord base_tcp;   // X_BT
  PoseRecord world_tcp;  // X_WT
  std::vector<JointRecord> joints;
};

// What a record says of `robot` at the tick of `time`; sequence and wall time stay for the sender to fill in.
[[nodiscard]] RobotRecord robot_record_of(const RobotState& robot, Timestamp time);

// Writes `record` into `bytes` and returns its length; header.kind and header.length are set here. Names beyond 63
// bytes are cut. Fails for more than kMaxJointsPerRobot joints and where `bytes` is too small (kMaxRobotRecordBytes
// always suffices).
[[nodiscard]] Result<std::size_t> encode_robot_record(const RobotRecord& record, std::span<std::byte> bytes);

// Strict: whatever the encoder would not write is refused (reserved bytes, text behind a name's NUL, unknown states),
// so that a layout of another version cannot pass for this one. Numbers are passed on as they are, NaN too.
[[nodiscard]] Result<RobotRecord> decode_robot_record(std::span<const std::byte> bytes);

}  // namespace cellmirror
