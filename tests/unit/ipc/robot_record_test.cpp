#include "ipc/wire/robot_record.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "tests/unit/ipc/golden_bytes.hpp"

namespace cellmirror {
namespace {

using test::Bytes;
using test::place;

// Written by hand from docs/messages.md: robot R1 with one prismatic joint, 344 bytes = 0x158.
Bytes golden_record() {
  Bytes bytes(344, std::byte{0});
  place(bytes, 0, "CMIR");
  place(bytes, 4, {0x01, 0x00});                                       // version 1
  place(bytes, 6, {0x01, 0x00});                                       // kind 1
  place(bytes, 8, {0x58, 0x01, 0x00, 0x00});                           // length
  place(bytes, 16, {0x07, 0, 0, 0, 0, 0, 0, 0});                       // sequence 7
  place(bytes, 24, {0x00, 0xCA, 0x9A, 0x3B, 0, 0, 0, 0});              // 1,000,000,000 ns
  place(bytes, 32, {0x00, 0x00, 0x2A, 0x36, 0xFE, 0x9C, 0x97, 0x17});  // 1,700,000,000,000,000,000 ns
  place(bytes, 40, "R1");                                              // id
  place(bytes, 104, {0x01, 0x01});                                     // online, fresh
  place(bytes, 106, {0x01, 0x00});                                     // one joint
  place(bytes, 112, {0x02, 0x01, 0, 0, 0, 0, 0, 0});                   // sample 258
  place(bytes, 120, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});                   // base: x 1
  place(bytes, 128, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F});                   // y 0.5
  place(bytes, 136, {0, 0, 0, 0, 0, 0, 0x00, 0xC0});                   // z -2
  place(bytes, 168, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});                   // qw 1
  place(bytes, 192, {0, 0, 0, 0, 0, 0, 0x08, 0x40});                   // world: z 3
  place(bytes, 216, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});                   // qz 1
  place(bytes, 232, "J1");                                             // joint name
  place(bytes, 296, {0x02, 0x02});                                     // prismatic, stale
  place(bytes, 304, {0, 0, 0, 0, 0, 0, 0xD0, 0x3F});                   // position 0.25
  place(bytes, 312, {0, 0, 0, 0, 0, 0, 0xE0, 0xBF});                   // velocity -0.5
  place(bytes, 320, {0, 0, 0, 0, 0, 0, 0x24, 0x40});                   // effort 10
  place(bytes, 328, {0, 0, 0, 0, 0, 0, 0xC0, 0x3F});                   // age 0.125
  place(bytes, 336, {0, 0, 0, 0, 0, 0, 0xF8, 0x7F});                   // source age NaN
  return bytes;
}

RobotRecord golden_values() {
  RobotRecord record;
  record.header.sequence = 7;
  record.header.time_ns = 1'000'000'000;
  record.header.wall_time_ns = 1'700'000'000'000'000'000;
  record.id = "R1";
  record.online = true;
  record.state = DataState::fresh;
  record.sample_sequence = 258;
  record.base_tcp = {{1, 0.5, -2}, {0, 0, 0, 1}};
  record.world_tcp = {{0, 0, 3}, {0, 0, 1, 0}};
  record.joints = {{"J1", JointKind::prismatic, DataState::stale, 0.25, -0.5, 10, 0.125, std::nan("")}};
  return record;
}

TEST(RobotRecord, IsEncodedAsDocumented) {
  Bytes encoded(kMaxRobotRecordBytes, std::byte{0xEE});
  const auto length = encode_robot_record(golden_values(), encoded);
  ASSERT_TRUE(length) << length.error().text();
  encoded.resize(*length);
  EXPECT_EQ(encoded, golden_record());
}

TEST(RobotRecord, IsDecodedAsDocumented) {
  const auto sut = decode_robot_record(golden_record());
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->header.kind, RecordKind::robot_parameters);
  EXPECT_EQ(sut->header.length, 344u);
  EXPECT_EQ(sut->header.sequence, 7u);
  EXPECT_EQ(sut->header.time_ns, 1'000'000'000);
  EXPECT_EQ(sut->header.wall_time_ns, 1'700'000'000'000'000'000);
  EXPECT_EQ(sut->id, "R1");
  EXPECT_TRUE(sut->online);
  EXPECT_EQ(sut->state, DataState::fresh);
  EXPECT_EQ(sut->sample_sequence, 258u);
  EXPECT_EQ(sut->base_tcp.position, (std::array<double, 3>{1, 0.5, -2}));
  EXPECT_EQ(sut->base_tcp.quaternion, (std::array<double, 4>{0, 0, 0, 1}));
  EXPECT_EQ(sut->world_tcp.position, (std::array<double, 3>{0, 0, 3}));
  EXPECT_EQ(sut->world_tcp.quaternion, (std::array<double, 4>{0, 0, 1, 0}));
  ASSERT_EQ(sut->joints.size(), 1u);
  EXPECT_EQ(sut->joints[0].name, "J1");
  EXPECT_EQ(sut->joints[0].kind, JointKind::prismatic);
  EXPECT_EQ(sut->joints[0].state, DataState::stale);
  EXPECT_EQ(sut->joints[0].position, 0.25);
  EXPECT_EQ(sut->joints[0].velocity, -0.5);
  EXPECT_EQ(sut->joints[0].effort, 10);
  EXPECT_EQ(sut->joints[0].age, 0.125);
  EXPECT_TRUE(std::isnan(sut->joints[0].source_age));
}

// Each entry breaks one thing that a reader of another version or of noise would stumble over.
TEST(RobotRecord, RefusesWhatTheEncoderWouldNotWrite) {
  struct Damage {
    std::size_t offset;
    int value;
    const char* what;
  };
  const Damage damages[] = {{0, 'X', "magic"},          {4, 2, "version"},       {6, 0, "kind 0"},
                            {6, 2, "another kind"},     {6, 9, "unknown kind"},  {8, 0x57, "length"},
                            {12, 1, "reserved"},        {104, 2, "online flag"}, {105, 5, "state"},
                            {106, 0, "too few joints"}, {106, 2, "more joints"}, {107, 1, "257 joints"},
                            {108, 1, "reserved"},       {43, 'x', "behind NUL"}, {235, 'x', "behind joint's NUL"},
                            {296, 3, "joint kind"},     {297, 5, "joint state"}, {298, 1, "joint reserved"},
                            {303, 1, "joint reserved"}};
  for (const Damage& damage : damages) {
    Bytes bytes = golden_record();
    bytes[damage.offset] = static_cast<std::byte>(damage.value);
    const auto sut = decode_robot_record(bytes);
    EXPECT_FALSE(sut) << damage.what;
    if (!sut) {
      EXPECT_FALSE(sut.error().what.empty());
    }
  }
}

TEST(RobotRecord, RefusesEveryShorterAndLongerMessage) {
  const Bytes golden = golden_record();
  for (std::size_t length = 0; length < golden.size(); ++length) {
    EXPECT_FALSE(decode_robot_record(std::span(golden).first(length))) << length;
  }
  Bytes longer = golden;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(decode_robot_record(longer));
  EXPECT_FALSE(decode_robot_record(Bytes(9000, std::byte{0})));
}

TEST(RobotRecord, NameWithoutNulIsRefused) {
  Bytes bytes = golden_record();
  for (std::size_t i = 40; i < 104; ++i) bytes[i] = std::byte{'a'};
  EXPECT_FALSE(decode_robot_record(bytes));
}

TEST(RobotRecord, LongNamesAreCutBetweenCharacters) {
  RobotRecord record = golden_values();
  record.id = std::string(62, 'a') + "\xC3\xA9" + "tail";  // the 63rd byte would split the e acute
  Bytes encoded(kMaxRobotRecordBytes);
  const auto length = encode_robot_record(record, encoded);
  ASSERT_TRUE(length);
  const auto sut = decode_robot_record(std::span(encoded).first(*length));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->id, std::string(62, 'a'));
}

TEST(RobotRecord, MostJointsFitOneMoreIsRefused) {
  RobotRecord record = golden_values();
  record.joints.resize(kMaxJointsPerRobot, record.joints.front());
  Bytes encoded(kMaxRobotRecordBytes);
  EXPECT_EQ(encode_robot_record(record, encoded), kMaxRobotRecordBytes);
  EXPECT_EQ(kMaxRobotRecordBytes, 2024u);
  EXPECT_FALSE(encode_robot_record(record, std::span(encoded).first(kMaxRobotRecordBytes - 1)));
  record.joints.push_back(record.joints.front());
  EXPECT_FALSE(encode_robot_record(record, encoded));
}

TEST(RobotRecord, RobotWithoutJointsIsARecord) {
  RobotRecord record = golden_values();
  record.joints.clear();
  Bytes encoded(kMaxRobotRecordBytes);
  const auto length = encode_robot_record(record, encoded);
  ASSERT_EQ(length, 232u);
  EXPECT_TRUE(decode_robot_record(std::span(encoded).first(232)));
}

TEST(RobotRecordOf, TellsAgesAndPoses) {
  RobotState robot;
  robot.id = "PUMA_762";
  robot.online = true;
  robot.sequence = 41;
  robot.state = DataState::fresh;
  const Timestamp time{2'000'000'000};
  robot.joints.push_back(
      {"J1", JointKind::revolute, 0.5, 0.1, 2.0, DataState::fresh, {}, time - Nanoseconds{250'000'000}});
  robot.joints.push_back({"J2", JointKind::revolute, 0, 0, 0, DataState::none, {}, {}});
  robot.joints.push_back(
      {"J3", JointKind::revolute, 0, 0, 0, DataState::fresh, time - Nanoseconds{500'000'000}, time + Nanoseconds{1}});
  // Half a turn and more about z: the quaternion's w would be negative.
  robot.X_WT = Eigen::AngleAxisd(1.5 * std::numbers::pi, Eigen::Vector3d::UnitZ());
  robot.X_WT.translation() = Eigen::Vector3d(1, 2, 3);

  const RobotRecord sut = robot_record_of(robot, time);
  EXPECT_EQ(sut.id, "PUMA_762");
  EXPECT_EQ(sut.sample_sequence, 41u);
  EXPECT_EQ(sut.header.time_ns, 2'000'000'000);
  EXPECT_DOUBLE_EQ(sut.joints.at(0).age, 0.25);
  EXPECT_TRUE(std::isnan(sut.joints.at(0).source_age));
  EXPECT_TRUE(std::isnan(sut.joints.at(1).age));
  EXPECT_EQ(sut.joints.at(2).age, 0) << "a value that came after the tick's instant is not younger than 0";
  EXPECT_DOUBLE_EQ(sut.joints.at(2).source_age, 0.5);
  EXPECT_EQ(sut.world_tcp.position, (std::array<double, 3>{1, 2, 3}));
  EXPECT_NEAR(sut.world_tcp.quaternion[2], -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(sut.world_tcp.quaternion[3], std::sqrt(0.5), 1e-12);
}

TEST(RobotRecordOf, ReadersThatKnowFiveStatesTakeTheLaterOnesForInvalid) {
  RobotState robot;
  robot.state = DataState::conflict;
  robot.joints.push_back({"J1", JointKind::revolute, 0, 0, 0, DataState::implausible, {}, {}});
  robot.joints.push_back({"J2", JointKind::revolute, 0, 0, 0, DataState::lost, {}, {}});
  const RobotRecord sut = robot_record_of(robot, Timestamp{1});
  EXPECT_EQ(sut.state, DataState::invalid);
  EXPECT_EQ(sut.joints.at(0).state, DataState::invalid);
  EXPECT_EQ(sut.joints.at(1).state, DataState::lost);
}

}  // namespace
}  // namespace cellmirror
