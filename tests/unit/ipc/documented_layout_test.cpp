// docs/messages.md, docs/examples/cellmirror_messages.h and the codec tell the same offsets.
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "docs/examples/cellmirror_messages.h"
#include "ipc/wire/barrier_record.hpp"
#include "ipc/wire/camera_record.hpp"
#include "ipc/wire/proximity_record.hpp"
#include "ipc/wire/range_record.hpp"
#include "ipc/wire/robot_record.hpp"
#include "ipc/wire/script_message.hpp"
#include "ipc/wire/tissue_record.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "tests/unit/ipc/documented_table.hpp"

namespace cellmirror {
namespace {

namespace header = record_offset;
namespace robot = robot_record_offset;
namespace range = range_record_offset;
namespace ranges = range_array_offset;
namespace camera = camera_record_offset;
namespace barrier = barrier_record_offset;
namespace proximity = proximity_record_offset;
namespace event = event_record_offset;
namespace tissue = tissue_record_offset;

using test::DocumentedField;

void expect_agreement(const std::string& title, std::initializer_list<DocumentedField> fields) {
  test::expect_agreement("messages.md", title, fields);
}

TEST(DocumentedLayout, OfTheHeader) {
  using Struct = cellmirror_header;
  expect_agreement(
      "Header", {{"magic", "u32", header::kMagic, offsetof(Struct, magic), CELLMIRROR_HEADER_OFFSET_MAGIC},
                 {"version", "u16", header::kVersion, offsetof(Struct, version), CELLMIRROR_HEADER_OFFSET_VERSION},
                 {"kind", "u16", header::kKind, offsetof(Struct, kind), CELLMIRROR_HEADER_OFFSET_KIND},
                 {"length", "u32", header::kLength, offsetof(Struct, length), CELLMIRROR_HEADER_OFFSET_LENGTH},
                 {"reserved", "u32", header::kReserved, offsetof(Struct, reserved), header::kReserved},
                 {"sequence", "u64", header::kSequence, offsetof(Struct, sequence), CELLMIRROR_HEADER_OFFSET_SEQUENCE},
                 {"time_ns", "i64", header::kTime, offsetof(Struct, time_ns), CELLMIRROR_HEADER_OFFSET_TIME_NS},
                 {"wall_time_ns", "i64", header::kWallTime, offsetof(Struct, wall_time_ns),
                  CELLMIRROR_HEADER_OFFSET_WALL_TIME_NS}});
  EXPECT_EQ(sizeof(Struct), header::kHeaderBytes);
  EXPECT_EQ(std::size_t{CELLMIRROR_HEADER_BYTES}, header::kHeaderBytes);
}

TEST(DocumentedLayout, OfARobot) {
  using Struct = cellmirror_robot;
  expect_agreement(
      "Robot parameters (kind 1)",
      {{"id", "char[64]", robot::kId, offsetof(Struct, id), CELLMIRROR_ROBOT_OFFSET_ID},
       {"online", "u8", robot::kOnline, offsetof(Struct, online), CELLMIRROR_ROBOT_OFFSET_ONLINE},
       {"state", "u8", robot::kState, offsetof(Struct, state), CELLMIRROR_ROBOT_OFFSET_STATE},
       {"joint_count", "u16", robot::kJointCount, offsetof(Struct, joint_count), CELLMIRROR_ROBOT_OFFSET_JOINT_COUNT},
       {"reserved", "u32", robot::kReserved, offsetof(Struct, reserved), robot::kReserved},
       {"sample_sequence", "u64", robot::kSampleSequence, offsetof(Struct, sample_sequence),
        CELLMIRROR_ROBOT_OFFSET_SAMPLE_SEQUENCE},
       {"base_tcp", "pose", robot::kBaseTcp, offsetof(Struct, base_tcp), CELLMIRROR_ROBOT_OFFSET_BASE_TCP},
       {"world_tcp", "pose", robot::kWorldTcp, offsetof(Struct, world_tcp), CELLMIRROR_ROBOT_OFFSET_WORLD_TCP},
       {"joints", "joint[joint_count]", robot::kJoints, offsetof(Struct, joints), CELLMIRROR_ROBOT_OFFSET_JOINTS}});
  EXPECT_EQ(sizeof(Struct), kMaxRobotRecordBytes);
}

TEST(DocumentedLayout, OfAPose) {
  using Struct = cellmirror_pose;
  expect_agreement("Pose", {{"position", "f64[3]", pose_offset::kPosition, offsetof(Struct, position), 0},
                            {"quaternion", "f64[4]", pose_offset::kQuaternion, offsetof(Struct, quaternion), 24}});
  EXPECT_EQ(sizeof(Struct), pose_offset::kBytes);
}

TEST(DocumentedLayout, OfAJoint) {
  using Struct = cellmirror_joint;
  expect_agreement(
      "Joint",
      {{"name", "char[64]", robot::kJointName, offsetof(Struct, name), CELLMIRROR_JOINT_OFFSET_NAME},
       {"kind", "u8", robot::kJointKind, offsetof(Struct, kind), CELLMIRROR_JOINT_OFFSET_KIND},
       {"state", "u8", robot::kJointState, offsetof(Struct, state), CELLMIRROR_JOINT_OFFSET_STATE},
       {"reserved", "u8[6]", robot::kJointReserved, offsetof(Struct, reserved), robot::kJointReserved},
       {"position", "f64", robot::kJointPosition, offsetof(Struct, position), CELLMIRROR_JOINT_OFFSET_POSITION},
       {"velocity", "f64", robot::kJointVelocity, offsetof(Struct, velocity), CELLMIRROR_JOINT_OFFSET_VELOCITY},
       {"effort", "f64", robot::kJointEffort, offsetof(Struct, effort), CELLMIRROR_JOINT_OFFSET_EFFORT},
       {"age_s", "f64", robot::kJointAge, offsetof(Struct, age_s), CELLMIRROR_JOINT_OFFSET_AGE_S},
       {"source_age_s", "f64", robot::kJointSourceAge, offsetof(Struct, source_age_s),
        CELLMIRROR_JOINT_OFFSET_SOURCE_AGE_S}});
  EXPECT_EQ(sizeof(Struct), robot::kJointBytes);
  EXPECT_EQ(std::size_t{CELLMIRROR_JOINT_BYTES}, robot::kJointBytes);
}

TEST(DocumentedLayout, OfARange) {
  using Struct = cellmirror_range;
  expect_agreement(
      "Ultrasonic range (kind 2)",
      {{"id", "char[64]", range::kId, offsetof(Struct, id), CELLMIRROR_RANGE_OFFSET_ID},
       {"object", "char[128]", range::kObject, offsetof(Struct, object), CELLMIRROR_RANGE_OFFSET_OBJECT},
       {"distance", "f64", range::kDistance, offsetof(Struct, distance), CELLMIRROR_RANGE_OFFSET_DISTANCE},
       {"range", "f64", range::kRange, offsetof(Struct, range), CELLMIRROR_RANGE_OFFSET_RANGE},
       {"blind_zone", "f64", range::kBlindZone, offsetof(Struct, blind_zone), CELLMIRROR_RANGE_OFFSET_BLIND_ZONE},
       {"half_angle", "f64", range::kHalfAngle, offsetof(Struct, half_angle), CELLMIRROR_RANGE_OFFSET_HALF_ANGLE},
       {"point", "f64[3]", range::kPoint, offsetof(Struct, point), CELLMIRROR_RANGE_OFFSET_POINT},
       {"flags", "u32", range::kFlags, offsetof(Struct, flags), CELLMIRROR_RANGE_OFFSET_FLAGS},
       {"reserved", "u32", range::kReserved, offsetof(Struct, reserved), range::kReserved}});
  EXPECT_EQ(sizeof(Struct), range::kBytes);
}

TEST(DocumentedLayout, OfAnArrayOfRanges) {
  using Struct = cellmirror_range_array;
  expect_agreement(
      "Ultrasonic ranges (kind 3)",
      {{"part", "u16", ranges::kPart, offsetof(Struct, part), CELLMIRROR_RANGE_ARRAY_OFFSET_PART},
       {"parts", "u16", ranges::kParts, offsetof(Struct, parts), CELLMIRROR_RANGE_ARRAY_OFFSET_PARTS},
       {"count", "u16", ranges::kCount, offsetof(Struct, count), CELLMIRROR_RANGE_ARRAY_OFFSET_COUNT},
       {"total", "u16", ranges::kTotal, offsetof(Struct, total), CELLMIRROR_RANGE_ARRAY_OFFSET_TOTAL},
       {"ranges", "entry[count]", ranges::kRanges, offsetof(Struct, ranges), CELLMIRROR_RANGE_ARRAY_OFFSET_RANGES}});
  EXPECT_EQ(sizeof(Struct), ranges::kRanges + kMaxRangesInRecord * ranges::kEntryBytes);
}

TEST(DocumentedLayout, OfARangeEntry) {
  using Struct = cellmirror_range_entry;
  expect_agreement(
      "Range entry",
      {{"id", "char[64]", ranges::kEntryId, offsetof(Struct, id), CELLMIRROR_RANGE_ENTRY_OFFSET_ID},
       {"distance", "f64", ranges::kEntryDistance, offsetof(Struct, distance), CELLMIRROR_RANGE_ENTRY_OFFSET_DISTANCE},
       {"range", "f64", ranges::kEntryRange, offsetof(Struct, range), CELLMIRROR_RANGE_ENTRY_OFFSET_RANGE},
       {"point", "f64[3]", ranges::kEntryPoint, offsetof(Struct, point), CELLMIRROR_RANGE_ENTRY_OFFSET_POINT},
       {"flags", "u32", ranges::kEntryFlags, offsetof(Struct, flags), CELLMIRROR_RANGE_ENTRY_OFFSET_FLAGS},
       {"reserved", "u32", ranges::kEntryReserved, offsetof(Struct, reserved), ranges::kEntryReserved}});
  EXPECT_EQ(sizeof(Struct), ranges::kEntryBytes);
}

TEST(DocumentedLayout, OfACamera) {
  using Struct = cellmirror_camera;
  expect_agreement("Camera parameters (kind 4)",
                   {{"id", "char[64]", camera::kId, offsetof(Struct, id), CELLMIRROR_CAMERA_OFFSET_ID},
                    {"tracks", "char[128]", camera::kTracks, offsetof(Struct, tracks), CELLMIRROR_CAMERA_OFFSET_TRACKS},
                    {"pose", "pose", camera::kPose, offsetof(Struct, pose), CELLMIRROR_CAMERA_OFFSET_POSE},
                    {"mount", "pose", camera::kMount, offsetof(Struct, mount), CELLMIRROR_CAMERA_OFFSET_MOUNT},
                    {"pan", "f64", camera::kPan, offsetof(Struct, pan), CELLMIRROR_CAMERA_OFFSET_PAN},
                    {"tilt", "f64", camera::kTilt, offsetof(Struct, tilt), CELLMIRROR_CAMERA_OFFSET_TILT},
                    {"focal_distance", "f64", camera::kFocalDistance, offsetof(Struct, focal_distance),
                     CELLMIRROR_CAMERA_OFFSET_FOCAL_DISTANCE},
                    {"fovy", "f64", camera::kFovy, offsetof(Struct, fovy), CELLMIRROR_CAMERA_OFFSET_FOVY},
                    {"flags", "u32", camera::kFlags, offsetof(Struct, flags), CELLMIRROR_CAMERA_OFFSET_FLAGS},
                    {"reserved", "u32", camera::kReserved, offsetof(Struct, reserved), camera::kReserved}});
  EXPECT_EQ(sizeof(Struct), camera::kBytes);
}

TEST(DocumentedLayout, OfProximity) {
  using Struct = cellmirror_proximity;
  expect_agreement(
      "Proximity (kind 5)",
      {{"check", "u64", proximity::kCheck, offsetof(Struct, check), CELLMIRROR_PROXIMITY_OFFSET_CHECK},
       {"warning_distance", "f64", proximity::kWarningDistance, offsetof(Struct, warning_distance),
        CELLMIRROR_PROXIMITY_OFFSET_WARNING_DISTANCE},
       {"computed_after_s", "f64", proximity::kComputedAfter, offsetof(Struct, computed_after_s),
        CELLMIRROR_PROXIMITY_OFFSET_COMPUTED_AFTER_S},
       {"tested", "u32", proximity::kTested, offsetof(Struct, tested), CELLMIRROR_PROXIMITY_OFFSET_TESTED},
       {"touching", "u32", proximity::kTouching, offsetof(Struct, touching), CELLMIRROR_PROXIMITY_OFFSET_TOUCHING},
       {"within_warning", "u32", proximity::kWithinWarning, offsetof(Struct, within_warning),
        CELLMIRROR_PROXIMITY_OFFSET_WITHIN_WARNING},
       {"doubts", "u32", proximity::kDoubts, offsetof(Struct, doubts), CELLMIRROR_PROXIMITY_OFFSET_DOUBTS},
       {"found", "u32", proximity::kFound, offsetof(Struct, found), CELLMIRROR_PROXIMITY_OFFSET_FOUND},
       {"pair_count", "u16", proximity::kPairCount, offsetof(Struct, pair_count),
        CELLMIRROR_PROXIMITY_OFFSET_PAIR_COUNT},
       {"reserved", "u16", proximity::kReserved, offsetof(Struct, reserved), proximity::kReserved},
       {"pairs", "pair[pair_count]", proximity::kPairs, offsetof(Struct, pairs), CELLMIRROR_PROXIMITY_OFFSET_PAIRS}});
  EXPECT_EQ(sizeof(Struct), kMaxProximityRecordBytes);
}

TEST(DocumentedLayout, OfAPair) {
  using Struct = cellmirror_pair;
  expect_agreement(
      "Pair",
      {{"a", "char[128]", proximity::kPairA, offsetof(Struct, a), CELLMIRROR_PAIR_OFFSET_A},
       {"b", "char[128]", proximity::kPairB, offsetof(Struct, b), CELLMIRROR_PAIR_OFFSET_B},
       {"distance", "f64", proximity::kPairDistance, offsetof(Struct, distance), CELLMIRROR_PAIR_OFFSET_DISTANCE},
       {"depth", "f64", proximity::kPairDepth, offsetof(Struct, depth), CELLMIRROR_PAIR_OFFSET_DEPTH},
       {"point_a", "f64[3]", proximity::kPairPointA, offsetof(Struct, point_a), CELLMIRROR_PAIR_OFFSET_POINT_A},
       {"point_b", "f64[3]", proximity::kPairPointB, offsetof(Struct, point_b), CELLMIRROR_PAIR_OFFSET_POINT_B},
       {"normal", "f64[3]", proximity::kPairNormal, offsetof(Struct, normal), CELLMIRROR_PAIR_OFFSET_NORMAL},
       {"closing_speed", "f64", proximity::kPairClosingSpeed, offsetof(Struct, closing_speed),
        CELLMIRROR_PAIR_OFFSET_CLOSING_SPEED},
       {"time_to_contact_s", "f64", proximity::kPairTimeToContact, offsetof(Struct, time_to_contact_s),
        CELLMIRROR_PAIR_OFFSET_TIME_TO_CONTACT_S},
       {"flags", "u32", proximity::kPairFlags, offsetof(Struct, flags), CELLMIRROR_PAIR_OFFSET_FLAGS},
       {"contacts", "u32", proximity::kPairContacts, offsetof(Struct, contacts), CELLMIRROR_PAIR_OFFSET_CONTACTS},
       {"contact_age_s", "f64", proximity::kPairContactAge, offsetof(Struct, contact_age_s),
        CELLMIRROR_PAIR_OFFSET_CONTACT_AGE_S}});
  EXPECT_EQ(sizeof(Struct), proximity::kPairBytes);
}

TEST(DocumentedLayout, OfAnEvent) {
  using Struct = cellmirror_event;
  expect_agreement("Proximity event (kind 6)",
                   {{"event", "u64", event::kEvent, offsetof(Struct, event), CELLMIRROR_EVENT_OFFSET_EVENT},
                    {"change", "u8", event::kChange, offsetof(Struct, change), CELLMIRROR_EVENT_OFFSET_CHANGE},
                    {"reserved", "u8[7]", event::kReserved, offsetof(Struct, reserved), event::kReserved},
                    {"distance", "f64", event::kDistance, offsetof(Struct, distance), CELLMIRROR_EVENT_OFFSET_DISTANCE},
                    {"a", "char[128]", event::kA, offsetof(Struct, a), CELLMIRROR_EVENT_OFFSET_A},
                    {"b", "char[128]", event::kB, offsetof(Struct, b), CELLMIRROR_EVENT_OFFSET_B}});
  EXPECT_EQ(sizeof(Struct), event::kBytes);
}

TEST(DocumentedLayout, OfATissueEvent) {
  using Struct = cellmirror_tissue_event;
  expect_agreement("Tissue event (kind 7)",
                   {{"event", "u64", tissue::kEvent, offsetof(Struct, event), CELLMIRROR_TISSUE_OFFSET_EVENT},
                    {"kind", "u8", tissue::kKind, offsetof(Struct, kind), CELLMIRROR_TISSUE_OFFSET_KIND},
                    {"limit", "u8", tissue::kLimit, offsetof(Struct, limit), CELLMIRROR_TISSUE_OFFSET_LIMIT},
                    {"reserved", "u8[6]", tissue::kReserved, offsetof(Struct, reserved), tissue::kReserved},
                    {"value", "f64", tissue::kValue, offsetof(Struct, value), CELLMIRROR_TISSUE_OFFSET_VALUE},
                    {"place", "f64[3]", tissue::kPlace, offsetof(Struct, place), CELLMIRROR_TISSUE_OFFSET_PLACE},
                    {"robot", "char[64]", tissue::kRobot, offsetof(Struct, robot), CELLMIRROR_TISSUE_OFFSET_ROBOT},
                    {"object", "char[64]", tissue::kObject, offsetof(Struct, object), CELLMIRROR_TISSUE_OFFSET_OBJECT},
                    {"part", "char[64]", tissue::kPart, offsetof(Struct, part), CELLMIRROR_TISSUE_OFFSET_PART}});
  EXPECT_EQ(sizeof(Struct), tissue::kBytes);
}

TEST(DocumentedLayout, OfALightBarrier) {
  using Struct = cellmirror_barrier;
  expect_agreement(
      "Light barrier (kind 8)",
      {{"id", "char[64]", barrier::kId, offsetof(Struct, id), CELLMIRROR_BARRIER_OFFSET_ID},
       {"object", "char[128]", barrier::kObject, offsetof(Struct, object), CELLMIRROR_BARRIER_OFFSET_OBJECT},
       {"interruptions", "u64", barrier::kInterruptions, offsetof(Struct, interruptions),
        CELLMIRROR_BARRIER_OFFSET_INTERRUPTIONS},
       {"flags", "u32", barrier::kFlags, offsetof(Struct, flags), CELLMIRROR_BARRIER_OFFSET_FLAGS},
       {"reserved", "u32", barrier::kReserved, offsetof(Struct, reserved), barrier::kReserved}});
  EXPECT_EQ(sizeof(Struct), barrier::kBytes);
}

TEST(DocumentedLayout, NamesOfTissueEvents) {
  for (std::size_t kind = 0; kind < kTissueEventWords.size(); ++kind)
    EXPECT_EQ(cellmirror_tissue_name(static_cast<unsigned>(kind)), kTissueEventWords.at(kind));
  EXPECT_STREQ(cellmirror_tissue_name(kTissueEventWords.size()), "unknown");
  EXPECT_EQ(CELLMIRROR_TISSUE_LIMIT, static_cast<int>(TissueEventKind::limit));
}

TEST(DocumentedLayout, ConstantsOfTheCHeader) {
  const QueueConfig queues;
  EXPECT_EQ(CELLMIRROR_SCRIPT_KEY, queues.script_key);
  EXPECT_EQ(CELLMIRROR_SENSOR_KEY, queues.sensor_key);
  EXPECT_EQ(CELLMIRROR_REPLY_KEY, queues.reply_key);
  EXPECT_EQ(CELLMIRROR_MESSAGE_TYPE, kScriptMessageType);
  EXPECT_EQ(CELLMIRROR_MESSAGE_TYPE, kSensorMessageType);
  EXPECT_EQ(CELLMIRROR_MAX_MESSAGE_BYTES, kMaxScriptMessageBytes);
  EXPECT_EQ(CELLMIRROR_MAX_MESSAGE_BYTES, kMaxRecordBytes);
  EXPECT_EQ(CELLMIRROR_MAX_REPLY_BYTES, kMaxReplyBytes);
  EXPECT_EQ(CELLMIRROR_MAX_TAG, kMaxReplyTag);
  EXPECT_EQ(CELLMIRROR_RECORD_MAGIC, kRecordMagic);
  EXPECT_EQ(CELLMIRROR_RECORD_VERSION, kRecordVersion);
  EXPECT_EQ(CELLMIRROR_KIND_ROBOT, static_cast<unsigned>(RecordKind::robot_parameters));
  EXPECT_EQ(CELLMIRROR_KIND_RANGE, static_cast<unsigned>(RecordKind::ultrasonic_range));
  EXPECT_EQ(CELLMIRROR_KIND_RANGE_ARRAY, static_cast<unsigned>(RecordKind::ultrasonic_range_array));
  EXPECT_EQ(CELLMIRROR_KIND_CAMERA, static_cast<unsigned>(RecordKind::camera_parameters));
  EXPECT_EQ(CELLMIRROR_KIND_PROXIMITY, static_cast<unsigned>(RecordKind::proximity));
  EXPECT_EQ(CELLMIRROR_KIND_EVENT, static_cast<unsigned>(RecordKind::proximity_event));
  EXPECT_EQ(CELLMIRROR_KIND_TISSUE_EVENT, static_cast<unsigned>(RecordKind::tissue_event));
  EXPECT_EQ(CELLMIRROR_KIND_BARRIER, static_cast<unsigned>(RecordKind::light_barrier));
  EXPECT_EQ(CELLMIRROR_BARRIER_INTERRUPTED, kBarrierInterrupted);
  EXPECT_EQ(CELLMIRROR_BARRIER_DOUBTFUL, kBarrierDoubtful);
  EXPECT_EQ(CELLMIRROR_RANGE_SEEN, kRangeSeen);
  EXPECT_EQ(CELLMIRROR_RANGE_IN_BLIND_ZONE, kRangeInBlindZone);
  EXPECT_EQ(CELLMIRROR_RANGE_DOUBTFUL, kRangeDoubtful);
  EXPECT_EQ(CELLMIRROR_CAMERA_TRACKING, kCameraTracking);
  EXPECT_EQ(CELLMIRROR_CAMERA_MIRRORED, kCameraMirrored);
  EXPECT_EQ(CELLMIRROR_PAIR_TOUCHING, kPairTouching);
  EXPECT_EQ(CELLMIRROR_PAIR_WITHIN_WARNING, kPairWithinWarning);
  EXPECT_EQ(CELLMIRROR_PAIR_DOUBTFUL, kPairDoubtful);
  EXPECT_EQ(CELLMIRROR_CHANGE_ENTERED_WARNING, static_cast<int>(ProximityChange::entered_warning));
  EXPECT_EQ(CELLMIRROR_CHANGE_TOUCHED, static_cast<int>(ProximityChange::touched));
  EXPECT_EQ(CELLMIRROR_CHANGE_PARTED, static_cast<int>(ProximityChange::parted));
  EXPECT_EQ(CELLMIRROR_CHANGE_LEFT_WARNING, static_cast<int>(ProximityChange::left_warning));
  EXPECT_EQ(static_cast<std::size_t>(CELLMIRROR_PATH_BYTES), kRecordPathBytes);
  EXPECT_EQ(static_cast<std::size_t>(CELLMIRROR_MAX_RANGES), kMaxRangesInRecord);
  EXPECT_EQ(static_cast<std::size_t>(CELLMIRROR_MAX_PAIRS), kMaxPairsInRecord);
  EXPECT_EQ(static_cast<std::size_t>(CELLMIRROR_NAME_BYTES), kRecordNameBytes);
  EXPECT_EQ(static_cast<std::size_t>(CELLMIRROR_MAX_JOINTS), kMaxJointsPerRobot);
  EXPECT_EQ(CELLMIRROR_STATE_NONE, static_cast<int>(DataState::none));
  EXPECT_EQ(CELLMIRROR_STATE_FRESH, static_cast<int>(DataState::fresh));
  EXPECT_EQ(CELLMIRROR_STATE_STALE, static_cast<int>(DataState::stale));
  EXPECT_EQ(CELLMIRROR_STATE_LOST, static_cast<int>(DataState::lost));
  EXPECT_EQ(CELLMIRROR_STATE_INVALID, static_cast<int>(DataState::invalid));
  EXPECT_EQ(CELLMIRROR_JOINT_REVOLUTE, static_cast<int>(JointKind::revolute));
  EXPECT_EQ(CELLMIRROR_JOINT_CONTINUOUS, static_cast<int>(JointKind::continuous));
  EXPECT_EQ(CELLMIRROR_JOINT_PRISMATIC, static_cast<int>(JointKind::prismatic));
}

}  // namespace
}  // namespace cellmirror
