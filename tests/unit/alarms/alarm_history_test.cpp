// Alarms at any time of a recording.
#include "app/alarms/alarm_history.hpp"

#include <gtest/gtest.h>

#include <string>

#include "app/alarms/alarm_line.hpp"

namespace cellmirror::app {
namespace {

constexpr std::int64_t kMs = 1'000'000;

Alarm alarm(std::uint64_t id, std::int64_t raised_ms, AlarmPriority priority = AlarmPriority::high) {
  return {.id = id,
          .kind = "stream",
          .subject = "ARM " + std::to_string(id),
          .text = "lost",
          .priority = priority,
          .first_ms = raised_ms,
          .raised_ms = raised_ms};
}

// One is raised at 1 s, cleared at 2 s, acknowledged at 3 s; another one at 4 s; one was there before.
class AlarmHistoryTest : public testing::Test {
 protected:
  AlarmHistoryTest() {
    const auto add = [&](std::int64_t ms, const Alarm& one) { sut_.add(ms * kMs, alarm_line_of(one)); };
    add(500, alarm(7, 100, AlarmPriority::low));
    Alarm one = alarm(8, 1000);
    add(1000, one);
    one.cleared_ms = 2000;
    add(2000, one);
    one.acknowledged_ms = 3000;
    one.acknowledged_by = "Ada";
    add(3000, one);
    add(4000, alarm(9, 4000));
  }
  AlarmHistory sut_;
};

TEST_F(AlarmHistoryTest, IsAsItWasAtAnyTime) {
  EXPECT_TRUE(sut_.at(0).open.empty());
  EXPECT_EQ(sut_.at(600 * kMs).open.size(), 1U);
  EXPECT_EQ(sut_.at(600 * kMs).counts.highest, AlarmPriority::low);
  const AlarmReport raised = sut_.at(1999 * kMs);
  ASSERT_EQ(raised.open.size(), 2U);
  EXPECT_EQ(raised.open.front().id, 8U) << "newest first";
  EXPECT_EQ(raised.counts.active(), 2U);
  EXPECT_EQ(raised.counts.highest, AlarmPriority::high);
  EXPECT_EQ(sut_.at(2500 * kMs).open.front().state(), AlarmState::cleared_unacknowledged);
  const AlarmReport over = sut_.at(3500 * kMs);
  ASSERT_EQ(over.history.size(), 1U);
  EXPECT_EQ(over.history.front().acknowledged_by, "Ada");
  EXPECT_EQ(over.open.size(), 1U);
}

// As after a seek.
TEST_F(AlarmHistoryTest, TimeMayGoBack) {
  const std::uint64_t late = sut_.at(9000 * kMs).counts.revision;
  EXPECT_EQ(sut_.at(1500 * kMs).open.size(), 2U);
  EXPECT_NE(sut_.at(1500 * kMs).counts.revision, late);
  EXPECT_EQ(sut_.at(9000 * kMs).counts.revision, late);
}

TEST_F(AlarmHistoryTest, EachRaiseIsToldOnce) {
  const auto raised = sut_.raised();
  ASSERT_EQ(raised.size(), 3U);
  EXPECT_EQ(raised[1].time_ms, 1000);
  EXPECT_EQ(raised[1].alarm.subject, "ARM 8");
}

TEST(AlarmHistoryLines, ThatAreWrongAreLeftOut) {
  AlarmHistory sut;
  for (const char* line : {"", "{", "[]", "null", R"({"id":1})", R"({"id":-1,"kind":"x"})"}) sut.add(kMs, line);
  sut.add(kMs, alarm_line_of(alarm(1, std::int64_t{1} << 44)));  // a time that nanoseconds do not have
  EXPECT_TRUE(sut.at(2 * kMs).open.empty());
  sut.add(5 * kMs, alarm_line_of(alarm(1, 5)));
  sut.add(4 * kMs, alarm_line_of(alarm(2, 4)));  // back: as if it came with the one before
  EXPECT_TRUE(sut.at(4 * kMs).open.empty());
  EXPECT_EQ(sut.at(5 * kMs).open.size(), 2U);
}

}  // namespace
}  // namespace cellmirror::app
