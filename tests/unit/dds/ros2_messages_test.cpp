#include "drivers/dds/ros2_messages.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "golden.hpp"

namespace cellmirror::dds::test {
namespace {

JointState golden_message() {
  return {.header = {.stamp = {1, 2}, .frame_id = "ab"},
          .name = {"j1", "j2"},
          .position = {1.0, -2.0},
          .velocity = {0.5, 2.5},
          .effort = {}};
}

void expect_golden(const JointState& message) {
  EXPECT_EQ(message.header.stamp, (RosTime{1, 2}));
  EXPECT_EQ(message.header.frame_id, "ab");
  EXPECT_EQ(message.name, (std::vector<std::string>{"j1", "j2"}));
  EXPECT_EQ(message.position, (std::vector<double>{1.0, -2.0}));
  EXPECT_EQ(message.velocity, (std::vector<double>{0.5, 2.5}));
  EXPECT_TRUE(message.effort.empty());
}

TEST(JointStateCodec, ReadsBothByteOrders) {
  JointState sut;
  ASSERT_EQ(decode(golden_joint_state_le(), sut), CdrFault::none);
  expect_golden(sut);
  sut = {};
  ASSERT_EQ(decode(golden_joint_state_be(), sut), CdrFault::none);
  expect_golden(sut);
}

TEST(JointStateCodec, WritesLittleEndianAsTheStandardSays) {
  std::vector<std::byte> written;
  encode(golden_message(), written);
  EXPECT_EQ(written, golden_joint_state_le());
}

TEST(JointStateCodec, AgreesWithAnotherImplementation) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    JointState message{.header = {.stamp = {round, 7}, .frame_id = std::string(random() % 9, 'f')}};
    for (std::size_t n = random() % 8; n > 0; --n) {
      message.name.emplace_back(random() % 12, 'n');
      message.position.push_back(static_cast<double>(random()) * 1e-3);
    }
    if (round % 2 == 0) message.velocity = message.position;
    if (round % 3 == 0) message.effort = message.position;

    std::vector<char> zeroed(8192);  // the library leaves padding as it finds it
    eprosima::fastcdr::FastBuffer buffer(zeroed.data(), zeroed.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS, eprosima::fastcdr::Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    cdr << message.header.stamp.sec << message.header.stamp.nanosec << message.header.frame_id;
    cdr << message.name << message.position << message.velocity << message.effort;
    const auto* theirs = reinterpret_cast<const std::byte*>(buffer.getBuffer());
    const std::vector<std::byte> expected(theirs, theirs + cdr.getSerializedDataLength());

    std::vector<std::byte> written;
    encode(message, written);
    EXPECT_TRUE(written == expected) << round;
    JointState read;
    ASSERT_EQ(decode(expected, read), CdrFault::none);
    EXPECT_EQ(read.name, message.name);
    EXPECT_EQ(read.position, message.position);
    EXPECT_EQ(read.velocity, message.velocity);
    EXPECT_EQ(read.effort, message.effort);
  }
}

// By hand: encapsulation CDR_LE, the length with the zero behind the text, the text.
TEST(StringCodec, WritesLittleEndianAsTheStandardSays) {
  std::vector<std::byte> written;
  encode(std::string_view("<r/>"), written);
  std::vector<std::byte> golden;
  for (const unsigned char b : std::string_view("\0\1\0\0\5\0\0\0<r/>\0", 13)) golden.push_back(std::byte{b});
  EXPECT_EQ(written, golden);
}

TEST(JointStateCodec, RefusesEveryTruncation) {
  const std::vector<std::byte> whole = golden_joint_state_le();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    JointStateView view;
    const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_NE(decode(part, view), CdrFault::none) << length;
  }
}

TEST(JointStateCodec, IgnoresBytesBehindTheMessage) {
  std::vector<std::byte> longer = golden_joint_state_le();
  longer.resize(longer.size() + 13, std::byte{0xff});
  JointState sut;
  ASSERT_EQ(decode(longer, sut), CdrFault::none);
  expect_golden(sut);
}

TEST(JointStateCodec, RefusesOtherEncapsulations) {
  for (const int kind : {2, 3, 6, 7, 9, 0xff}) {
    std::vector<std::byte> other = golden_joint_state_le();
    other[1] = static_cast<std::byte>(kind);
    JointStateView view;
    EXPECT_EQ(decode(other, view), CdrFault::encapsulation) << kind;
  }
}

TEST(JointStateCodec, RefusesTextWithoutItsZero) {
  std::vector<std::byte> wrong = golden_joint_state_le();
  wrong[4 + 14] = std::byte{'c'};  // the zero of frame_id
  JointStateView view;
  EXPECT_EQ(decode(wrong, view), CdrFault::text);
}

TEST(JointStateCodec, HostileLengthsNeverTakeMemory) {
  // A number of elements or bytes that the payload cannot hold, in each place that has one.
  for (const std::size_t place : {8U, 16U, 20U, 36U, 56U, 80U}) {
    for (const std::uint32_t length : {0xffffffffU, 0x80000000U, 0x20000000U, 0x7fffffffU, 1000U}) {
      std::vector<std::byte> wrong = golden_joint_state_le();
      std::memcpy(&wrong[4 + place], &length, sizeof length);
      JointState message;
      EXPECT_NE(decode(wrong, message), CdrFault::none) << place << ' ' << length;
      EXPECT_LE(message.name.capacity(), 64U);
      EXPECT_LE(message.position.capacity(), 64U);
    }
  }
}

TEST(JointStateCodec, RefusesMoreJointsThanAnyRobotHas) {
  JointState message;
  message.name.resize(kMaxJointsInMessage + 1);
  std::vector<std::byte> written;
  encode(message, written);
  JointStateView view;
  EXPECT_EQ(decode(written, view), CdrFault::too_many);
}

TEST(JointStateCodec, TextIsCutAtAZero) {
  std::vector<std::byte> written;
  encode(JointState{.name = {std::string("a\0b", 3)}, .position = {1}}, written);
  JointState read;
  ASSERT_EQ(decode(written, read), CdrFault::none);
  EXPECT_EQ(read.name, std::vector<std::string>{"a"});
}

TEST(JointStateCodec, AcceptsTheEmptyMessage) {
  std::vector<std::byte> written;
  encode(JointState{}, written);
  JointStateView view;
  EXPECT_EQ(decode(written, view), CdrFault::none);
  EXPECT_TRUE(view.name.empty());
  EXPECT_TRUE(view.position.empty());
}

TEST(TfMessageCodec, MatchesTheStandardsBytes) {
  const std::vector<std::byte> golden = golden_tf_message_le();
  TfMessage sut;
  ASSERT_EQ(decode(golden, sut), CdrFault::none);
  ASSERT_EQ(sut.transforms.size(), 1U);
  EXPECT_EQ(sut.transforms[0].header.stamp, (RosTime{5, 6}));
  EXPECT_EQ(sut.transforms[0].header.frame_id, "w");
  EXPECT_EQ(sut.transforms[0].child_frame_id, "c");
  EXPECT_EQ(sut.transforms[0].translation, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(sut.transforms[0].rotation, (std::array<double, 4>{0, 0, 0, 1}));
  std::vector<std::byte> written;
  encode(sut, written);
  EXPECT_EQ(written, golden);
}

TEST(TfMessageCodec, RefusesTruncationsAndHostileCounts) {
  const std::vector<std::byte> whole = golden_tf_message_le();
  TfMessage message;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_NE(decode(part, message), CdrFault::none) << length;
  }
  for (const std::uint32_t count : {2U, 4096U, 0xffffffffU}) {
    std::vector<std::byte> wrong = whole;
    std::memcpy(&wrong[4], &count, sizeof count);
    TfMessage fresh;
    EXPECT_NE(decode(wrong, fresh), CdrFault::none) << count;
    EXPECT_LE(fresh.transforms.capacity(), 2U);
  }
}

TEST(RosTimes, ConvertToNanosecondsAndBack) {
  EXPECT_EQ(wall_clock_ns({1, 2}), 1'000'000'002);
  EXPECT_EQ(ros_time(1'000'000'002), (RosTime{1, 2}));
  EXPECT_EQ(ros_time(-1), RosTime{});
  EXPECT_EQ(ros_time(std::int64_t{1} << 62), RosTime{}) << "after 2038 such a stamp has no seconds";
}

TEST(RosTimes, ThatAreNoneGiveNothing) {
  EXPECT_FALSE(wall_clock_ns({0, 0}));
  EXPECT_FALSE(wall_clock_ns({-1, 5}));
  EXPECT_FALSE(wall_clock_ns({5, 1'000'000'000}));
}

}  // namespace
}  // namespace cellmirror::dds::test
