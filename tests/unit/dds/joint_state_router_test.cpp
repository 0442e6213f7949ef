#include "drivers/dds/joint_state_router.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "golden.hpp"
#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror::dds::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

class RecordingSink final : public JointSampleSink {
 public:
  bool push(const JointSample& sample) noexcept override {
    if (full) return false;
    samples.push_back(sample);
    return true;
  }
  std::vector<JointSample> samples;
  bool full = false;
};

std::vector<std::byte> encoded(const JointState& message) {
  std::vector<std::byte> out;
  encode(message, out);
  return out;
}

class Payloads final : public PayloadSink {
 public:
  void take(std::span<const std::byte> payload, Timestamp receive_time) override {
    taken.emplace_back(payload.begin(), payload.end());
    times.push_back(receive_time);
  }
  std::vector<std::vector<std::byte>> taken;
  std::vector<Timestamp> times;
};

struct Robot {
  explicit Robot(const std::vector<DdsJointConfig>& joints) : feed(RobotFeed::make(joints).value()) {}
  std::unique_ptr<RobotFeed> feed;
  RecordingSink sink;
};

class JointStateRouterTest : public testing::Test {
 protected:
  void accept(const JointState& message, MessageOrigin origin = {}) {
    now_ = now_ + Nanoseconds(1'000'000);
    sut_.accept(encoded(message), now_, origin);
  }

  Robot arm_{{{"shoulder", 0, 1.0, 0.0}, {"elbow", 1, 1.0, 0.0}, {"wrist", 2, 1.0, 0.0}}};
  Timestamp now_{1'000'000'000};
  JointStateRouter sut_;
};

TEST_F(JointStateRouterTest, MatchesReorderedAndPartialMessagesByName) {
  sut_.add(*arm_.feed, arm_.sink);
  accept({.name = {"wrist", "shoulder"}, .position = {3.0, 1.0}, .velocity = {0.3, 0.1}, .effort = {30, 10}});
  ASSERT_EQ(arm_.sink.samples.size(), 1U);
  const JointSample& sample = arm_.sink.samples[0];
  EXPECT_EQ(sample.present, 0b101U);
  EXPECT_EQ(sample.position[0], 1.0);
  EXPECT_EQ(sample.position[2], 3.0);
  EXPECT_EQ(sample.velocity[2], 0.3);
  EXPECT_EQ(sample.effort[0], 10.0);
  EXPECT_EQ(sample.receive_time, now_);
  EXPECT_EQ(sample.source_time, Timestamp{});
  EXPECT_EQ(sample.sequence, 1U);
}

TEST_F(JointStateRouterTest, LeavesOtherRobotsMessagesAlone) {
  sut_.add(*arm_.feed, arm_.sink);
  accept({.name = {"somebody", "else"}, .position = {1.0}});
  EXPECT_TRUE(arm_.sink.samples.empty());
  EXPECT_EQ(arm_.feed->counters().rejected, 0U);
}

TEST_F(JointStateRouterTest, ServesSeveralRobotsFromOneMessage) {
  Robot other{{{"boom", 0, 1.0, 0.0}, {"elbow", 5, 1.0, 0.0}}};
  sut_.add(*arm_.feed, arm_.sink);
  sut_.add(*other.feed, other.sink);
  accept({.name = {"boom", "elbow"}, .position = {7.0, 8.0}});
  ASSERT_EQ(arm_.sink.samples.size(), 1U);
  ASSERT_EQ(other.sink.samples.size(), 1U);
  EXPECT_EQ(arm_.sink.samples[0].present, 0b10U);
  EXPECT_EQ(other.sink.samples[0].present, 0b100001U);
  EXPECT_EQ(other.sink.samples[0].position[5], 8.0);
}

TEST_F(JointStateRouterTest, GivesEachMessageOnceAsItCame) {
  Robot other{{{"boom", 0, 1.0, 0.0}, {"elbow", 5, 1.0, 0.0}}};
  const auto of_arm = std::make_shared<Payloads>();
  const auto of_other = std::make_shared<Payloads>();
  arm_.feed->set_payload_sink(of_arm);
  other.feed->set_payload_sink(of_other);
  sut_.add(*arm_.feed, arm_.sink);
  sut_.add(*other.feed, other.sink);
  const JointState both{.name = {"boom", "elbow"}, .position = {7.0, 8.0}};
  accept(both);
  EXPECT_EQ(of_arm->taken, (std::vector<std::vector<std::byte>>{encoded(both)}));
  EXPECT_EQ(of_arm->times.back(), now_);
  EXPECT_TRUE(of_other->taken.empty());
  accept({.name = {"boom"}, .position = {7.0}});
  EXPECT_EQ(of_other->taken.size(), 1U);
  accept({.name = {"nobody"}, .position = {1.0}});
  EXPECT_EQ(of_arm->taken.size() + of_other->taken.size(), 2U);
  const std::vector<std::byte> malformed(3, std::byte{7});
  sut_.accept(malformed, now_);
  EXPECT_EQ(of_arm->taken.back(), malformed);
}

TEST_F(JointStateRouterTest, ScalesAndShifts) {
  Robot robot{{{"j", 0, -2.0, 0.5}}};
  sut_.add(*robot.feed, robot.sink);
  accept({.name = {"j"}, .position = {3.0}, .velocity = {4.0}, .effort = {8.0}});
  EXPECT_EQ(robot.sink.samples.at(0).position[0], -5.5);
  EXPECT_EQ(robot.sink.samples.at(0).velocity[0], -8.0);
  EXPECT_EQ(robot.sink.samples.at(0).effort[0], -4.0) << "power stays the same";
}

TEST_F(JointStateRouterTest, RefusesPositionsThatAreNotFiniteJointByJoint) {
  sut_.add(*arm_.feed, arm_.sink);
  accept({.name = {"shoulder", "elbow", "wrist"}, .position = {kNan, 2.0, -kInf}});
  ASSERT_EQ(arm_.sink.samples.size(), 1U);
  EXPECT_EQ(arm_.sink.samples[0].present, 0b010U);
  EXPECT_EQ(arm_.sink.samples[0].refused, 0b101U);
  EXPECT_EQ(arm_.feed->counters().rejected, 2U);
  EXPECT_EQ(arm_.feed->last_errors().size(), 2U);
}

TEST_F(JointStateRouterTest, RefusesWhatScalingMakesInfinite) {
  Robot robot{{{"j", 0, 1e10, 0.0}}};
  sut_.add(*robot.feed, robot.sink);
  accept({.name = {"j"}, .position = {1e300}});
  EXPECT_EQ(robot.sink.samples.at(0).refused, 1U);
  accept({.name = {"j"}, .position = {1.0}, .velocity = {1e300}});
  EXPECT_EQ(robot.sink.samples.at(1).present, 1U);
  EXPECT_EQ(robot.sink.samples.at(1).velocity[0], 0.0);
  EXPECT_EQ(robot.feed->counters().rejected, 2U);
}

TEST_F(JointStateRouterTest, TakesNanVelocityAndEffortAsNotMeasured) {
  sut_.add(*arm_.feed, arm_.sink);
  accept({.name = {"shoulder"}, .position = {1.0}, .velocity = {kNan}, .effort = {kNan}});
  EXPECT_EQ(arm_.sink.samples.at(0).present, 1U);
  EXPECT_EQ(arm_.sink.samples.at(0).velocity[0], 0.0);
  EXPECT_EQ(arm_.feed->counters().rejected, 0U);
  EXPECT_EQ(arm_.feed->counters().unknown, 2U);
  accept({.name = {"shoulder"}, .position = {1.0}, .velocity = {kInf}});
  EXPECT_EQ(arm_.sink.samples.at(1).present, 1U);
  EXPECT_EQ(arm_.feed->counters().rejected, 1U);
}

TEST_F(JointStateRouterTest, RefusesMessagesWhoseArraysDoNotFit) {
  sut_.add(*arm_.feed, arm_.sink);
  accept({.name = {"shoulder", "elbow"}, .position = {1.0}});
  accept({.name = {"shoulder", "elbow"}, .position = {1.0, 2.0, 3.0}});
  accept({.name = {"shoulder", "elbow"}, .position = {}, .velocity = {1.0, 2.0}});
  accept({.name = {"shoulder", "elbow"}, .position = {1.0, 2.0}, .velocity = {1.0}});
  accept({.name = {"shoulder", "elbow"}, .position = {1.0, 2.0}, .velocity = {}, .effort = {1.0}});
  EXPECT_TRUE(arm_.sink.samples.empty());
  EXPECT_EQ(arm_.feed->counters().rejected, 5U);
  EXPECT_EQ(arm_.feed->counters().wrong_length, 5U);
  accept({.name = {"shoulder", "elbow"}, .position = {1.0, 2.0}});
  EXPECT_EQ(arm_.sink.samples.size(), 1U) << "and goes on";
}

TEST_F(JointStateRouterTest, RefusesAJointThatIsNamedTwice) {
  sut_.add(*arm_.feed, arm_.sink);
  accept({.name = {"elbow", "shoulder", "elbow"}, .position = {1.0, 2.0, 3.0}});
  EXPECT_EQ(arm_.sink.samples.at(0).present, 0b01U);
  EXPECT_EQ(arm_.sink.samples.at(0).refused, 0b10U);
  EXPECT_EQ(arm_.sink.samples.at(0).position[1], 0.0);
}

TEST_F(JointStateRouterTest, CountsPayloadsThatAreNoJointState) {
  sut_.add(*arm_.feed, arm_.sink);
  sut_.accept(bytes({0xff, 0xff, 0xff, 0xff, 0xff}), now_);
  sut_.accept({}, now_);
  EXPECT_EQ(arm_.feed->counters().malformed, 2U);
  EXPECT_EQ(arm_.feed->counters().rejected, 2U);
}

TEST_F(JointStateRouterTest, SaysHowLongASampleWasThatIsTooLong) {
  sut_.add(*arm_.feed, arm_.sink);
  sut_.refuse_too_long(2'000'000, 1'048'576);
  EXPECT_EQ(arm_.feed->counters().malformed, 1U);
  EXPECT_EQ(arm_.feed->counters().rejected, 1U);
  EXPECT_EQ(arm_.feed->last_errors().back(), "a sample of 2000000 bytes is refused: at most 1048576 are taken");
}

TEST_F(JointStateRouterTest, MovesStampsToOurClock) {
  SystemClock clock;
  sut_.add(*arm_.feed, arm_.sink);
  const Timestamp then = clock.now();
  accept({.header = {.stamp = ros_time(to_wall_clock_ns(then))}, .name = {"elbow"}, .position = {1.0}});
  EXPECT_NEAR(seconds(arm_.sink.samples.at(0).source_time - then), 0.0, 1e-3);
  accept({.header = {.stamp = {7, 1'000'000'000}}, .name = {"elbow"}, .position = {1.0}});
  EXPECT_FALSE(arm_.sink.samples.at(1).source_time.known());
  EXPECT_EQ(arm_.feed->counters().bad_stamps, 1U);
}

TEST_F(JointStateRouterTest, ReportsHowOldStampsAreOnArrival) {
  sut_.add(*arm_.feed, arm_.sink);
  const auto age_of = [&](RosTime stamp) {
    accept({.header = {.stamp = stamp}, .name = {"elbow"}, .position = {1.0}});
    return arm_.feed->report().stamp_age;
  };
  EXPECT_EQ(age_of({}), std::nullopt) << "it has none";
  EXPECT_EQ(age_of({7, 1'000'000'000}), std::nullopt) << "it is no time";
  constexpr double kTolerance_s = 2e-3;  // accept() moves the time of arrival on
  for (const double age_s : {0.5, -0.5}) {
    const auto stamp = ros_time(to_wall_clock_ns(now_) - static_cast<std::int64_t>(age_s * 1e9));
    EXPECT_NEAR(seconds(*age_of(stamp)), age_s, kTolerance_s);
  }
  EXPECT_GT(seconds(*age_of({1, 0})), 1e9) << "1970";
  EXPECT_EQ(age_of({}), std::nullopt) << "as of the newest message";
}

TEST_F(JointStateRouterTest, CountsWhatIsMissingInAPublishersSequence) {
  sut_.add(*arm_.feed, arm_.sink);
  const JointState message{.name = {"elbow"}, .position = {1.0}};
  accept(message, {.publisher = 1, .sequence = 100});
  accept(message, {.publisher = 1, .sequence = 101});
  EXPECT_EQ(arm_.feed->counters().lost, 0U);
  accept(message, {.publisher = 1, .sequence = 105});
  EXPECT_EQ(arm_.feed->counters().lost, 3U);
  accept(message, {.publisher = 2, .sequence = 1});
  EXPECT_EQ(arm_.feed->counters().lost, 3U) << "another publisher has its own sequence";
  accept(message, {.publisher = 1, .sequence = 104});
  accept(message, {.publisher = 1, .sequence = 106});
  EXPECT_EQ(arm_.feed->counters().lost, 3U);
  sut_.forget(1);
  accept(message, {.publisher = 1, .sequence = 900});
  EXPECT_EQ(arm_.feed->counters().lost, 3U) << "a new life of the publisher";
}

TEST_F(JointStateRouterTest, GivesEachGapToOneMessagesRobotsOnly) {
  Robot other{{{"boom", 0, 1.0, 0.0}}};
  sut_.add(*arm_.feed, arm_.sink);
  sut_.add(*other.feed, other.sink);
  accept({.name = {"elbow"}, .position = {1.0}}, {1, 1});
  accept({.name = {"boom"}, .position = {1.0}}, {1, 2});
  accept({.name = {"elbow"}, .position = {1.0}}, {1, 4});
  EXPECT_EQ(arm_.feed->counters().lost + other.feed->counters().lost, 1U);
  accept({.name = {"stranger"}, .position = {1.0}}, {1, 6});
  accept({.name = {"boom"}, .position = {1.0}}, {1, 7});
  EXPECT_EQ(arm_.feed->counters().lost + other.feed->counters().lost, 2U);
}

TEST_F(JointStateRouterTest, CountsWhatAFullSinkRefuses) {
  sut_.add(*arm_.feed, arm_.sink);
  arm_.sink.full = true;
  accept({.name = {"elbow"}, .position = {1.0}});
  EXPECT_EQ(arm_.feed->counters().received, 0U);
  EXPECT_EQ(arm_.feed->counters().sink_full, 1U);
}

TEST_F(JointStateRouterTest, PushesNothingAfterRemoval) {
  sut_.add(*arm_.feed, arm_.sink);
  sut_.remove(*arm_.feed);
  accept({.name = {"elbow"}, .position = {1.0}});
  EXPECT_TRUE(arm_.sink.samples.empty());
  sut_.add(*arm_.feed, arm_.sink);
  accept({.name = {"elbow"}, .position = {1.0}});
  EXPECT_EQ(arm_.sink.samples.size(), 1U);
}

TEST_F(JointStateRouterTest, KeepsFewErrorsAndTheNewest) {
  sut_.add(*arm_.feed, arm_.sink);
  for (std::size_t n = 2; n < 40; ++n) {
    accept({.name = {"elbow"}, .position = std::vector<double>(n, 1.0)});
    accept({.name = {"elbow"}, .position = std::vector<double>(n, 1.0)});
  }
  EXPECT_EQ(arm_.feed->last_errors().size(), RobotFeed::kKeptErrors);
  EXPECT_NE(arm_.feed->last_errors().back().find("39 positions"), std::string::npos);
}

TEST_F(JointStateRouterTest, LeavesTheHeapAloneForMessagesOfAShapeSeenBefore) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  class CountingSink final : public JointSampleSink {
   public:
    bool push(const JointSample&) noexcept override { return ++count > 0; }
    int count = 0;
  } sink;
  sut_.add(*arm_.feed, sink);
  const std::vector<std::byte> payload = encoded(
      {.name = {"shoulder", "elbow", "wrist"}, .position = {1, 2, 3}, .velocity = {1, 2, 3}, .effort = {1, 2, 3}});
  sut_.accept(payload, now_, {1, 1});
  const AllocationGuard guard;
  for (std::uint64_t i = 2; i < 100; ++i) sut_.accept(payload, now_, {1, i});
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(sink.count, 99);
}

TEST(RobotFeed, RefusesMappingsThatCannotBeMeant) {
  EXPECT_FALSE(RobotFeed::make({}).has_value());
  EXPECT_FALSE(RobotFeed::make({{"", 0, 1.0, 0.0}}).has_value());
  EXPECT_FALSE(RobotFeed::make({{"a", kMaxJointsPerRobot, 1.0, 0.0}}).has_value());
  EXPECT_FALSE(RobotFeed::make({{"a", 0, 0.0, 0.0}}).has_value());
  EXPECT_FALSE(RobotFeed::make({{"a", 0, kNan, 0.0}}).has_value());
  EXPECT_FALSE(RobotFeed::make({{"a", 0, 1.0, kInf}}).has_value());
  EXPECT_FALSE(RobotFeed::make({{"a", 0, 1.0, 0.0}, {"a", 1, 1.0, 0.0}}).has_value());
  EXPECT_FALSE(RobotFeed::make({{"a", 0, 1.0, 0.0}, {"b", 0, 1.0, 0.0}}).has_value());
}

MessageOrigin from(std::uint8_t publisher) {
  MessageOrigin origin{.publisher = publisher, .sequence = 0};
  origin.guid[15] = publisher;
  return origin;
}

TEST_F(JointStateRouterTest, AJointOfTwoPublishersIsInConflictAndBothAreNamed) {
  sut_.add(*arm_.feed, arm_.sink);
  accept({.name = {"shoulder", "elbow"}, .position = {1.0, 2.0}}, from(1));
  accept({.name = {"shoulder", "wrist"}, .position = {1.6, 3.0}}, from(2));
  EXPECT_EQ(arm_.sink.samples.back().conflict, 0U) << "it may have been started again";
  accept({.name = {"shoulder", "elbow"}, .position = {1.0, 2.0}}, from(1));
  EXPECT_EQ(arm_.sink.samples.back().conflict, 0b001U);
  EXPECT_EQ(arm_.sink.samples.back().present, 0b010U) << "the elbow has one publisher";
  accept({.name = {"shoulder", "wrist"}, .position = {1.6, 3.0}}, from(2));
  EXPECT_EQ(arm_.sink.samples.back().conflict, 0b001U);
  EXPECT_EQ(arm_.sink.samples.back().present, 0b100U);
  const FeedReport& report = arm_.feed->report();
  EXPECT_EQ(report.counters.conflicts, 2U);
  EXPECT_EQ(report.last_conflict, now_);
  EXPECT_EQ(arm_.feed->ros_name(report.conflict_joint), "shoulder");
  EXPECT_EQ(report.publisher[15], 2);
  EXPECT_EQ(report.other_publisher[15], 1);
  EXPECT_EQ(arm_.feed->last_errors().back(),
            "two publishers name joint 'shoulder': 00.00.00.00.00.00.00.00.00.00.00.00|00.00.00.02 and "
            "00.00.00.00.00.00.00.00.00.00.00.00|00.00.00.01");
}

TEST_F(JointStateRouterTest, AConflictEndsASecondAfterTheOtherPublisherIsSilent) {
  sut_.add(*arm_.feed, arm_.sink);
  for (int i = 0; i < 4; ++i) accept({.name = {"shoulder"}, .position = {1.0}}, from(i % 2 == 0 ? 1 : 2));
  ASSERT_EQ(arm_.sink.samples.back().conflict, 1U);
  for (int i = 0; i < 1000; ++i) accept({.name = {"shoulder"}, .position = {1.0}}, from(2));
  EXPECT_EQ(arm_.sink.samples.back().conflict, 1U);
  accept({.name = {"shoulder"}, .position = {1.0}}, from(2));
  EXPECT_EQ(arm_.sink.samples.back().conflict, 0U);
  EXPECT_EQ(arm_.sink.samples.back().present, 1U);
  EXPECT_FALSE(arm_.feed->report().last_conflict.known());
}

TEST_F(JointStateRouterTest, PublishersThatFollowEachOtherAreNoConflictAndManyThatGoRoundAre) {
  sut_.add(*arm_.feed, arm_.sink);
  for (std::uint8_t publisher = 1; publisher < 100; ++publisher) {
    accept({.name = {"shoulder"}, .position = {1.0}}, from(publisher));
    ASSERT_EQ(arm_.sink.samples.back().conflict, 0U);
  }
  for (int i = 0; i < 7; ++i)
    accept({.name = {"shoulder"}, .position = {1.0}}, from(static_cast<std::uint8_t>(101 + i % 5)));
  EXPECT_EQ(arm_.sink.samples.back().conflict, 1U);
  for (int i = 0; i < 4; ++i) accept({.name = {"wrist"}, .position = {1.0}}, {});
  EXPECT_EQ(arm_.sink.samples.back().conflict, 0U) << "of an unknown publisher nothing is said";
}

}  // namespace
}  // namespace cellmirror::dds::test
