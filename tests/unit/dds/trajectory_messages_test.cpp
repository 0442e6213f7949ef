// The bytes of trajectories.
#include "drivers/dds/trajectory_messages.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string_view>

#include "tests/unit/dds/golden.hpp"

namespace cellmirror::dds {
namespace {

using test::bytes;

// trajectory_msgs/JointTrajectory, written by hand from the IDL and the rules of classic CDR.
const std::vector<std::byte> kGolden = bytes({
    0x00, 0x01, 0x00, 0x00,                          // CDR_LE
    0x0A, 0x00, 0x00, 0x00, 0x00, 0xCA, 0x9A, 0x3B,  // stamp: 10 s, 1,000,000,000 ns (too many)
});

TEST(TrajectoryMessages, ReadsWhatItWrites) {
  JointTrajectory message;
  message.start_wall_ns = 1'700'000'000'250'000'000;
  message.joints = {"a", "joint_2"};
  message.points = {{{1, 2}, {}, {}, {}, Nanoseconds(0)},
                    {{3, 4}, {5, 6}, {7, 8}, {9, 10}, Nanoseconds(1'500'000'000)}};
  std::vector<std::byte> payload;
  encode(message, payload);
  JointTrajectory again;
  ASSERT_EQ(decode(payload, again), CdrFault::none);
  EXPECT_EQ(again.start_wall_ns, message.start_wall_ns);
  EXPECT_EQ(again.joints, message.joints);
  ASSERT_EQ(again.points.size(), 2U);
  EXPECT_EQ(again.points[1].positions, message.points[1].positions);
  EXPECT_EQ(again.points[1].velocities, message.points[1].velocities);
  EXPECT_EQ(again.points[1].accelerations, message.points[1].accelerations);
  EXPECT_EQ(again.points[1].effort, message.points[1].effort);
  EXPECT_EQ(again.points[1].time_from_start, message.points[1].time_from_start);
  for (std::size_t size = 0; size < payload.size(); ++size)
    EXPECT_NE(decode(std::span(payload).first(size), again), CdrFault::none) << size;
}

// Byte by byte from the IDL: header (stamp, frame_id), joint_names, points (positions, velocities, accelerations,
// effort, time_from_start).
TEST(TrajectoryMessages, HasTheLayoutOfTheIdl) {
  JointTrajectory message;
  message.joints = {"a"};
  message.points = {{{1.0}, {}, {}, {}, Nanoseconds(2'000'000'003)}};
  std::vector<std::byte> payload;
  encode(message, payload);
  const std::vector<std::byte> expected = bytes({
      0x00, 0x01, 0x00, 0x00,                          // CDR_LE
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // stamp
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // frame_id "", padding
      0x01, 0x00, 0x00, 0x00,                          // one joint
      0x02, 0x00, 0x00, 0x00, 0x61, 0x00, 0x00, 0x00,  // "a", padding
      0x01, 0x00, 0x00, 0x00,                          // one point
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // one position, padding to 8
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF0, 0x3F,  // 1.0
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // no velocities, no accelerations
      0x00, 0x00, 0x00, 0x00,                          // no effort
      0x02, 0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00,  // 2 s, 3 ns
  });
  EXPECT_EQ(payload, expected);
}

TEST(TrajectoryMessages, RefusesTimesThatAreNone) {
  JointTrajectory message;
  EXPECT_EQ(decode(kGolden, message), CdrFault::time);
}

TEST(TrajectoryMessages, RefusesMorePointsAndJointsThanItTakes) {
  JointTrajectory message;
  message.points.resize(kMaxTrajectoryPoints + 1);
  std::vector<std::byte> payload;
  encode(message, payload);
  JointTrajectory again;
  EXPECT_EQ(decode(payload, again), CdrFault::too_many);
  message.points.clear();
  message.joints.assign(kMaxTrajectoryJoints + 1, "a");
  encode(message, payload);
  EXPECT_EQ(decode(payload, again), CdrFault::too_many);
  // A length without what it counts takes no memory.
  payload.resize(4 + 8 + 8);
  for (int i = 0; i < 2; ++i) payload.insert(payload.end(), 4, i == 0 ? std::byte{0x00} : std::byte{0x7F});
  EXPECT_EQ(decode(payload, again), CdrFault::truncated);
}

TEST(TrajectoryMessages, DurationsBelowZeroGoAndComeBack) {
  for (const std::int64_t ns : {-1LL, -1'000'000'000LL, -1'500'000'000LL, 0LL, 999'999'999LL}) {
    std::vector<std::byte> payload;
    CdrWriter out(payload);
    write_duration(Nanoseconds(ns), out);
    CdrReader in(payload);
    EXPECT_EQ(read_duration(in).count(), ns);
  }
}

}  // namespace
}  // namespace cellmirror::dds
