// Each fault does exactly what it says, in virtual time and with a fixed seed.
#include "sim_devices/faults/fault_pipeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>
#include <vector>

#include "sim_devices/faults/can_traits.hpp"

namespace cellmirror::sim {
namespace {

using ::testing::ElementsAre;

constexpr Timestamp kStart{1'000'000'000};
constexpr Nanoseconds kMs{1'000'000};

Timestamp at_ms(std::int64_t ms) { return kStart + ms * kMs; }

// A frame that bears its number in id and data.
Outgoing<CanFrame> numbered(int number, Timestamp time, Source source = {1, 1},
                            MessageKind kind = MessageKind::sample) {
  Outgoing<CanFrame> message{time, source, kind, {}};
  message.message.id = 0x181;
  message.message.length = 8;
  message.message.data[0] = static_cast<std::uint8_t>(number);
  message.message.data[1] = static_cast<std::uint8_t>(number >> 8);
  return message;
}

int number_of(const CanFrame& frame) { return frame.data[0] + 256 * frame.data[1]; }

struct Sent {
  std::int64_t ms;
  int number;
  bool operator==(const Sent&) const = default;
};

class FaultPipelineTest : public ::testing::Test {
 public:
  void add(const char* spec) {
    const auto parsed = parse_fault(spec);
    ASSERT_TRUE(parsed) << parsed.error().text();
    sut.schedule().add(*parsed, kStart);
  }

  // One frame a millisecond, numbered from 0, and a poll every millisecond until `until_ms`.
  void feed(int count, std::int64_t until_ms = -1) {
    for (std::int64_t ms = 0; ms < std::max<std::int64_t>(count, until_ms); ++ms) {
      if (ms < count) sut.push(at_ms(ms), numbered(static_cast<int>(ms), at_ms(ms)));
      poll(ms);
    }
  }

  void poll(std::int64_t ms) {
    std::vector<Outgoing<CanFrame>> out;
    sut.poll(at_ms(ms), out);
    for (const auto& message : out) {
      sent.push_back({ms, number_of(message.message)});
      frames.push_back(message);
    }
  }

  [[nodiscard]] std::vector<int> numbers() const {
    std::vector<int> result;
    for (const Sent& s : sent) result.push_back(s.number);
    return result;
  }

  FaultPipeline<CanFrame> sut{42};
  std::vector<Sent> sent;
  std::vector<Outgoing<CanFrame>> frames;
};

TEST_F(FaultPipelineTest, WithoutFaultsEverythingPassesAtOnceAndInOrder) {
  feed(3);
  EXPECT_THAT(sent, ElementsAre(Sent{0, 0}, Sent{1, 1}, Sent{2, 2}));
  EXPECT_EQ(sut.next(), kNeverEnds);
}

TEST_F(FaultPipelineTest, LossByCountTakesEachNth) {
  add("loss:every=3");
  feed(7);
  EXPECT_THAT(numbers(), ElementsAre(0, 1, 3, 4, 6));
}

TEST_F(FaultPipelineTest, LossByChanceIsSeededAndNearItsProbability) {
  add("loss:p=0.1");
  feed(10'000);
  // Binomial: 1000 expected, standard deviation 30.
  EXPECT_NEAR(10'000.0 - static_cast<double>(sent.size()), 1000.0, 150.0);
  EXPECT_EQ(sut.schedule().all().front().applied, 10'000 - sent.size());

  FaultPipeline<CanFrame> again(42);
  again.schedule().add(*parse_fault("loss:p=0.1"), kStart);
  std::vector<Outgoing<CanFrame>> out;
  for (int i = 0; i < 10'000; ++i) again.push(at_ms(i), numbered(i, at_ms(i)));
  again.poll(at_ms(10'000), out);
  ASSERT_EQ(out.size(), sent.size());
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_EQ(number_of(out[i].message), sent[i].number);
}

TEST_F(FaultPipelineTest, OneFaultMoreDoesNotChangeWhomTheOthersStrike) {
  add("loss:p=0.5");
  feed(100);
  FaultPipeline<CanFrame> other(42);
  other.schedule().add(*parse_fault("loss:p=0.5"), kStart);
  other.schedule().add(*parse_fault("corrupt:p=0.5"), kStart);
  std::vector<Outgoing<CanFrame>> out;
  for (int i = 0; i < 100; ++i) other.push(at_ms(i), numbered(i, at_ms(i)));
  other.poll(at_ms(100), out);
  EXPECT_EQ(out.size(), sent.size());
}

TEST_F(FaultPipelineTest, AWindowBeginsAndEnds) {
  add("loss@0.002..0.004");
  feed(6);
  EXPECT_THAT(numbers(), ElementsAre(0, 1, 4, 5));
}

TEST_F(FaultPipelineTest, CountBoundsHowOften) {
  add("loss:count=2");
  feed(4);
  EXPECT_THAT(numbers(), ElementsAre(2, 3));
}

TEST_F(FaultPipelineTest, DelayShiftsByItsTime) {
  add("delay:s=0.003");
  feed(2, 10);
  EXPECT_THAT(sent, ElementsAre(Sent{3, 0}, Sent{4, 1}));
}

TEST_F(FaultPipelineTest, NextTellsWhenADelayedMessageLeaves) {
  add("delay:s=0.003");
  sut.push(at_ms(0), numbered(0, at_ms(0)));
  EXPECT_EQ(sut.next(), at_ms(3));
}

TEST_F(FaultPipelineTest, JitterStaysWithinItsBounds) {
  add("delay:s=0.002,jitter=0.004");
  for (int i = 0; i < 500; ++i) {
    std::vector<Outgoing<CanFrame>> out;
    const Timestamp now = at_ms(100 * i);
    sut.push(now, numbered(i, now));
    const Nanoseconds late = sut.next() - now;
    EXPECT_GE(late, 2 * kMs);
    EXPECT_LT(late, 6 * kMs);
    sut.poll(now + 10 * kMs, out);
    EXPECT_EQ(out.size(), 1U);
  }
}

TEST_F(FaultPipelineTest, RepeatSendsCopiesApart) {
  add("repeat:n=2,s=0.002,every=2");
  feed(2, 8);
  EXPECT_THAT(sent, ElementsAre(Sent{0, 0}, Sent{1, 1}, Sent{3, 1}, Sent{5, 1}));
}

TEST_F(FaultPipelineTest, InsertSendsForeignFramesAtItsRate) {
  add("insert:rate=500,id=0x7AA@..0.010");
  feed(0, 20);
  ASSERT_EQ(frames.size(), 5U);
  for (const auto& frame : frames) {
    EXPECT_EQ(frame.kind, MessageKind::foreign);
    EXPECT_EQ(frame.message.id, 0x7AAU);
  }
  EXPECT_EQ(sut.next(), kNeverEnds);
}

TEST_F(FaultPipelineTest, ReorderLetsLaterMessagesPass) {
  add("reorder:every=3,n=2");
  feed(8);
  // 2 and 5 are held; each leaves after two others.
  EXPECT_THAT(numbers(), ElementsAre(0, 1, 3, 4, 2, 6, 7, 5));
}

TEST_F(FaultPipelineTest, AHeldMessageLeavesAfterASecondEvenIfNothingPasses) {
  add("reorder:every=1");
  sut.push(at_ms(0), numbered(7, at_ms(0)));
  EXPECT_EQ(sut.next(), at_ms(1000));
  poll(999);
  EXPECT_TRUE(sent.empty());
  poll(1000);
  EXPECT_THAT(sent, ElementsAre(Sent{1000, 7}));
}

TEST_F(FaultPipelineTest, CorruptFlipsAsManyBitsAsItSays) {
  add("corrupt:n=1");
  feed(64);
  ASSERT_EQ(frames.size(), 64U);
  for (int i = 0; i < 64; ++i) {
    const CanFrame before = numbered(i, kStart).message;
    const CanFrame& after = frames[static_cast<std::size_t>(i)].message;
    int flipped = 0;
    for (std::size_t b = 0; b < 8; ++b) flipped += std::popcount(static_cast<unsigned>(before.data[b] ^ after.data[b]));
    EXPECT_EQ(flipped, 1);
    EXPECT_EQ(after.id, before.id);
  }
}

TEST_F(FaultPipelineTest, WrongIdIsNeverTheOwnOne) {
  add("wrong-id");
  feed(5000);
  std::set<std::uint32_t> ids;
  for (const auto& frame : frames) ids.insert(frame.message.id);
  EXPECT_FALSE(ids.contains(0x181));
  EXPECT_FALSE(ids.contains(0));
  EXPECT_LE(*ids.rbegin(), 0x7FFU);
  EXPECT_GT(ids.size(), 1000U);
}

TEST_F(FaultPipelineTest, WrongIdMayBeGiven) {
  add("wrong-id:id=0x182");
  feed(1);
  EXPECT_EQ(frames.front().message.id, 0x182U);
  EXPECT_FALSE(frames.front().message.extended);
}

TEST_F(FaultPipelineTest, WrongLengthShortensAndStaysWithinTheFormat) {
  add("wrong-length:by=-2,every=2");
  add("wrong-length:by=5");
  feed(2);
  EXPECT_EQ(frames[0].message.length, 8);  // 8 + 5 is beyond a classic frame
  add("wrong-length:by=-64");
  feed(1);
  EXPECT_EQ(frames.back().message.length, 0);
}

TEST_F(FaultPipelineTest, BurstGathersAndLeavesAllAtOnceInOrder) {
  add("burst:s=0.004");
  feed(6, 12);
  EXPECT_THAT(sent, ElementsAre(Sent{4, 0}, Sent{4, 1}, Sent{4, 2}, Sent{4, 3}, Sent{8, 4}, Sent{8, 5}));
}

TEST_F(FaultPipelineTest, BusOffIsAnErrorFrameThenSilenceThenARestart) {
  add("bus-off@0.002..0.005");
  feed(8);
  std::vector<MessageKind> kinds;
  for (const auto& frame : frames) kinds.push_back(frame.kind);
  constexpr auto kSample = MessageKind::sample;
  constexpr auto kError = MessageKind::bus_error;
  EXPECT_THAT(kinds, ElementsAre(kSample, kSample, kError, kError, kSample, kSample, kSample));
  EXPECT_TRUE(frames[2].message.error);
  EXPECT_EQ(frames[2].message.id, 0x40U);   // CAN_ERR_BUSOFF
  EXPECT_EQ(frames[3].message.id, 0x100U);  // CAN_ERR_RESTARTED
  EXPECT_EQ(sent[3].ms, 5);
}

TEST_F(FaultPipelineTest, EndingABusOffByCommandRestartsTheBus) {
  add("bus-off");
  feed(2);
  EXPECT_EQ(sut.end(FaultKind::bus_off, at_ms(2)), 1U);
  sut.push(at_ms(2), numbered(2, at_ms(2)));
  poll(2);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].message.id, 0x100U);
  EXPECT_EQ(number_of(frames[2].message), 2);
}

TEST_F(FaultPipelineTest, OnlyStrikesTheKindRobotAndJointItNames) {
  add("loss:only=heartbeat,robot=2,joint=3");
  const auto pass = [&](Source source, MessageKind kind) {
    const std::size_t before = frames.size();
    sut.push(at_ms(0), numbered(0, at_ms(0), source, kind));
    poll(0);
    return frames.size() > before;
  };
  EXPECT_TRUE(pass({2, 3}, MessageKind::sample));
  EXPECT_TRUE(pass({1, 3}, MessageKind::heartbeat));
  EXPECT_TRUE(pass({2, 1}, MessageKind::heartbeat));
  EXPECT_FALSE(pass({2, 3}, MessageKind::heartbeat));
}

TEST_F(FaultPipelineTest, FaultsActOneAfterTheOther) {
  add("repeat");
  add("loss:every=2");
  feed(3);
  EXPECT_THAT(numbers(), ElementsAre(0, 1, 2));  // of each pair one is lost
}

TEST_F(FaultPipelineTest, RepetitionsOfRepetitionsAreBounded) {
  for (int i = 0; i < 5; ++i) add("repeat:n=1000");
  sut.push(kStart, numbered(0, kStart));
  poll(0);
  EXPECT_LE(sent.size(), FaultPipeline<CanFrame>::kMostCopiesOfOne + 1);
  EXPECT_GT(sut.overflowed(), 0U);
}

TEST_F(FaultPipelineTest, WhatWaitsIsBounded) {
  add("delay:s=1000");
  for (std::size_t i = 0; i < FaultPipeline<CanFrame>::kMostWaiting + 5; ++i) sut.push(kStart, numbered(0, kStart));
  EXPECT_EQ(sut.overflowed(), 5U);
}

TEST(FaultSchedule, FrozenKeepsTheFirstValueOfTheWindowAndLetsGo) {
  FaultSchedule sut(1);
  sut.add(*parse_fault("frozen:joint=2@0.002..0.004"), kStart);
  std::vector<double> seen;
  std::vector<double> other;
  for (int ms = 0; ms < 6; ++ms) {
    std::array<JointValue, 2> values{JointValue{10.0 + ms, 0, 0}, JointValue{20.0 + ms, 1, 0}};
    sut.shape(at_ms(ms), 1, values);
    other.push_back(values[0].position);
    seen.push_back(values[1].position);
  }
  EXPECT_THAT(seen, ElementsAre(20, 21, 22, 22, 24, 25));
  EXPECT_THAT(other, ElementsAre(10, 11, 12, 13, 14, 15));
}

TEST(FaultSchedule, JumpAddsAndNanSpoils) {
  FaultSchedule sut(1);
  sut.add(*parse_fault("jump:by=0.5,joint=1"), kStart);
  sut.add(*parse_fault("nan:joint=2,every=2"), kStart);
  std::array<JointValue, 2> values{JointValue{1, 0, 0}, JointValue{2, 0, 0}};
  sut.shape(kStart, 1, values);
  EXPECT_DOUBLE_EQ(values[0].position, 1.5);
  EXPECT_DOUBLE_EQ(values[1].position, 2);
  sut.shape(kStart, 1, values);
  EXPECT_TRUE(std::isnan(values[1].position));
}

TEST(FaultSchedule, DeathHasAWindowAndAVictim) {
  FaultSchedule sut(1);
  sut.add(*parse_fault("death:robot=2@0.002..0.004"), kStart);
  EXPECT_TRUE(sut.alive(at_ms(1), {2, 1}));
  EXPECT_FALSE(sut.alive(at_ms(2), {2, 1}));
  EXPECT_TRUE(sut.alive(at_ms(2), {1, 1}));
  EXPECT_TRUE(sut.alive(at_ms(4), {2, 1}));
}

TEST(FaultSchedule, FaultsEndByNumberKindOrAllTogether) {
  FaultSchedule sut(1);
  const int first = sut.add(*parse_fault("loss"), kStart);
  sut.add(*parse_fault("loss"), kStart);
  sut.add(*parse_fault("death"), kStart);
  EXPECT_EQ(sut.remove(first).size(), 1U);
  EXPECT_EQ(sut.remove(first).size(), 0U);
  EXPECT_EQ(sut.remove(FaultKind::death).size(), 1U);
  EXPECT_EQ(sut.remove(0).size(), 1U);
  EXPECT_TRUE(sut.empty());
}

}  // namespace
}  // namespace cellmirror::sim
