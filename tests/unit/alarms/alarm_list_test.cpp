// The states of ISA-18.2: what has to be acknowledged, what is over, and what is bounded.
#include "app/alarms/alarm_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace cellmirror::app {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;
using testing::SizeIs;

class AlarmListTest : public testing::Test {
 protected:
  AlarmMoment at(Nanoseconds time) { return {Timestamp{1 + time.count()}, 1'000'000 + time.count() / 1'000'000}; }
  static AlarmCondition condition(const std::string& subject, AlarmPriority priority = AlarmPriority::medium,
                                  Nanoseconds off_delay = {}) {
    return {.kind = "stream",
            .subject = subject,
            .text = "text of " + subject,
            .priority = priority,
            .off_delay = off_delay};
  }
  void look(std::vector<AlarmCondition> conditions) { sut_.update(conditions, at(now_)); }
  void later(Nanoseconds by) { now_ += by; }
  Alarm only() {
    const std::vector<Alarm> open = sut_.open();
    EXPECT_THAT(open, SizeIs(1));
    return open.empty() ? Alarm{} : open.front();
  }

  AlarmList sut_;
  Nanoseconds now_{1s};
};

TEST_F(AlarmListTest, IsActiveAndUnacknowledgedWhenItsConditionBegins) {
  look({condition("A")});
  const Alarm alarm = only();
  EXPECT_EQ(alarm.state(), AlarmState::unacknowledged);
  EXPECT_EQ(alarm.text, "text of A");
  EXPECT_EQ(alarm.raised_ms, at(now_).wall_ms);
  EXPECT_EQ(sut_.counts().unacknowledged(), 1U);
  EXPECT_EQ(sut_.counts().highest, AlarmPriority::medium);
}

TEST_F(AlarmListTest, IsOverWhenItWasAcknowledgedAndItsConditionEnds) {
  look({condition("A")});
  ASSERT_EQ(sut_.acknowledge(1, "Ada", at(now_)), 1U);
  EXPECT_EQ(only().state(), AlarmState::acknowledged);
  EXPECT_EQ(sut_.counts().unacknowledged(), 0U);
  EXPECT_EQ(sut_.counts().highest, std::nullopt);
  later(1s);
  look({});
  EXPECT_THAT(sut_.open(), IsEmpty());
  ASSERT_THAT(sut_.history(), SizeIs(1));
  EXPECT_EQ(sut_.history()[0].state(), AlarmState::normal);
  EXPECT_EQ(sut_.history()[0].acknowledged_by, "Ada");
}

TEST_F(AlarmListTest, StaysUntilItIsAcknowledgedWhereItsConditionEndsFirst) {
  look({condition("A")});
  const std::int64_t seen_ms = at(now_).wall_ms;
  later(1s);
  look({});
  EXPECT_EQ(only().state(), AlarmState::cleared_unacknowledged);
  EXPECT_EQ(only().cleared_ms, seen_ms);
  EXPECT_EQ(sut_.counts().active(), 0U);
  EXPECT_EQ(sut_.acknowledge(std::nullopt, "Ada", at(now_)), 1U);
  EXPECT_THAT(sut_.open(), IsEmpty());
  EXPECT_THAT(sut_.history(), SizeIs(1));
}

TEST_F(AlarmListTest, HasToBeAcknowledgedAgainWhereItComesAgain) {
  look({condition("A")});
  later(1s);
  look({});
  later(1s);
  look({condition("A")});
  EXPECT_EQ(only().state(), AlarmState::unacknowledged);
  EXPECT_EQ(only().occurrences, 2U);
  EXPECT_LT(only().first_ms, only().raised_ms);
  ASSERT_TRUE(sut_.acknowledge(1, "Ada", at(now_)));
  later(1s);
  look({});
  later(1s);
  look({condition("A")});
  EXPECT_EQ(only().id, 2U) << "what was over is another alarm";
}

TEST_F(AlarmListTest, HasToBeAcknowledgedAgainWhereItBecomesWorse) {
  look({condition("A", AlarmPriority::medium)});
  ASSERT_TRUE(sut_.acknowledge(1, "Ada", at(now_)));
  later(1s);
  look({condition("A", AlarmPriority::high)});
  EXPECT_EQ(only().state(), AlarmState::unacknowledged);
  EXPECT_EQ(only().priority, AlarmPriority::high);
  EXPECT_EQ(only().acknowledged_by, "");
  ASSERT_TRUE(sut_.acknowledge(1, "Bo", at(now_)));
  later(1s);
  look({condition("A", AlarmPriority::medium)});
  EXPECT_EQ(only().state(), AlarmState::acknowledged) << "better is no news";
}

TEST_F(AlarmListTest, IsNotClearedBeforeItsDelayIsOver) {
  look({condition("A", AlarmPriority::low, 10s)});
  for (int i = 0; i < 4; ++i) {
    later(9s);
    look({});
    EXPECT_EQ(only().state(), AlarmState::unacknowledged);
    look({condition("A", AlarmPriority::low, 10s)});
  }
  EXPECT_EQ(only().occurrences, 1U) << "chattering is one alarm";
  later(10s);
  look({});
  EXPECT_EQ(only().state(), AlarmState::cleared_unacknowledged);
}

TEST_F(AlarmListTest, ChangesItsRevisionOnlyWhereSomethingChanges) {
  look({condition("A")});
  const std::uint64_t before = sut_.counts().revision;
  later(1s);
  look({condition("A")});
  EXPECT_EQ(sut_.counts().revision, before);
  ASSERT_TRUE(sut_.acknowledge(std::nullopt, "Ada", at(now_)));
  EXPECT_GT(sut_.counts().revision, before);
  const std::uint64_t acknowledged = sut_.counts().revision;
  EXPECT_EQ(sut_.acknowledge(std::nullopt, "Bo", at(now_)), 0U);
  EXPECT_EQ(sut_.counts().revision, acknowledged);
  EXPECT_EQ(only().acknowledged_by, "Ada") << "who was first stays";
}

TEST_F(AlarmListTest, RefusesAnAlarmThatIsNotOpenAndNamesThatAreNone) {
  look({condition("A")});
  EXPECT_FALSE(sut_.acknowledge(2, "Ada", at(now_)));
  EXPECT_FALSE(sut_.acknowledge(1, "", at(now_)));
  EXPECT_FALSE(sut_.acknowledge(1, std::string(AlarmList::kMostNameBytes + 1, 'a'), at(now_)));
  const auto number = sut_.acknowledge(std::nullopt, "12", at(now_));
  ASSERT_FALSE(number);
  EXPECT_THAT(number.error().text(), testing::HasSubstr("ALARM_ACK Ada 12"));
  EXPECT_EQ(only().state(), AlarmState::unacknowledged);
}

TEST_F(AlarmListTest, IsBoundedHoweverMuchHappens) {
  std::vector<AlarmCondition> many;
  for (std::size_t i = 0; i < AlarmList::kMostOpen + 7; ++i) many.push_back(condition(std::to_string(i)));
  look(many);
  EXPECT_THAT(sut_.open(), SizeIs(AlarmList::kMostOpen));
  EXPECT_EQ(sut_.counts().not_listed, 7U);
  ASSERT_TRUE(sut_.acknowledge(std::nullopt, "Ada", at(now_)));
  later(1s);
  look({});
  EXPECT_EQ(sut_.counts().not_listed, 0U);
  look({condition("one more")});
  ASSERT_TRUE(sut_.acknowledge(std::nullopt, "Ada", at(now_)));
  later(1s);
  look({});
  EXPECT_THAT(sut_.history(), SizeIs(AlarmList::kMostHistory));
  EXPECT_EQ(sut_.history().front().subject, "one more");
}

TEST_F(AlarmListTest, CutsTextsToOneLineOfBoundedLength) {
  AlarmCondition long_one = condition("A\nB" + std::string(1000, 'x'));
  long_one.text = "two\nlines \xFF" + std::string(1000, 'y');
  look({long_one});
  EXPECT_EQ(only().subject.size(), AlarmList::kMostSubjectBytes);
  EXPECT_TRUE(only().text.starts_with("two?lines ?"));
  EXPECT_EQ(only().text.size(), AlarmList::kMostTextBytes);
  later(1s);
  look({long_one});
  EXPECT_EQ(only().occurrences, 1U) << "the same condition is the same alarm";
}

TEST_F(AlarmListTest, GoesOnWithTheAlarmsOfAnEarlierRun) {
  look({condition("A"), condition("B")});
  ASSERT_TRUE(sut_.acknowledge(2, "Ada", at(now_)));
  later(1s);
  look({condition("A")});  // B is over
  AlarmList next;
  for (const Alarm& alarm : sut_.history()) ASSERT_TRUE(next.restore(alarm, at(now_)));
  for (const Alarm& alarm : sut_.open()) ASSERT_TRUE(next.restore(alarm, at(now_)));
  EXPECT_EQ(next.open(), sut_.open());
  EXPECT_EQ(next.history(), sut_.history());
  // Found again in time, it is the same alarm; else it is cleared as of the start.
  next.update(std::vector{condition("A"), condition("C")}, at(now_ + 5s));
  ASSERT_THAT(next.open(), SizeIs(2));
  EXPECT_EQ(next.open()[0].id, 3U) << "numbers are not used twice";
  EXPECT_EQ(next.open()[1].occurrences, 1U);
  AlarmList alone;
  ASSERT_TRUE(alone.restore(only(), at(now_)));
  alone.update({}, at(now_ + 11s));
  EXPECT_EQ(alone.open().at(0).state(), AlarmState::cleared_unacknowledged);
}

TEST_F(AlarmListTest, RefusesWhatContradictsItselfInAFile) {
  Alarm one{.id = 7, .kind = "near", .subject = "A"};
  ASSERT_TRUE(sut_.restore(one, at(now_)));
  EXPECT_FALSE(sut_.restore(one, at(now_))) << "the same number";
  one.id = 8;
  EXPECT_FALSE(sut_.restore(one, at(now_))) << "open twice";
  one.id = 0;
  EXPECT_FALSE(sut_.restore(one, at(now_)));
  one.id = AlarmList::kMostIds + 1;
  EXPECT_FALSE(sut_.restore(one, at(now_)));
}

// Whatever comes in whatever order: what is active is listed, nothing is lost that nobody acknowledged.
TEST_F(AlarmListTest, KeepsItsPromisesOverARandomHistory) {
  std::uint32_t random = 1;
  const auto draw = [&](std::uint32_t below) { return (random = random * 1664525U + 1013904223U) / 7 % below; };
  std::set<std::string> unacknowledged;
  for (int step = 0; step < 3000; ++step) {
    later(1s);
    std::vector<AlarmCondition> now;
    for (const char* subject : {"A", "B", "C", "D", "E"}) {
      if (draw(2) == 0) now.push_back(condition(subject, static_cast<AlarmPriority>(draw(3))));
    }
    look(now);
    const std::vector<Alarm> open = sut_.open();
    for (const AlarmCondition& condition : now) {
      EXPECT_TRUE(std::ranges::any_of(open, [&](const Alarm& alarm) {
        return alarm.subject == condition.subject && !alarm.cleared_ms && alarm.priority >= condition.priority;
      }));
    }
    for (const std::string& subject : unacknowledged)
      EXPECT_TRUE(std::ranges::any_of(open, [&](const Alarm& alarm) { return alarm.subject == subject; }));
    unacknowledged.clear();
    for (const Alarm& alarm : open) {
      EXPECT_NE(alarm.state(), AlarmState::normal);
      if (!alarm.acknowledged_ms) unacknowledged.insert(alarm.subject);
    }
    if (draw(4) == 0 && !open.empty()) {
      const Alarm& alarm = open[draw(static_cast<std::uint32_t>(open.size()))];
      ASSERT_TRUE(sut_.acknowledge(alarm.id, "Ada", at(now_)));
      unacknowledged.erase(alarm.subject);
    }
  }
}

}  // namespace
}  // namespace cellmirror::app
