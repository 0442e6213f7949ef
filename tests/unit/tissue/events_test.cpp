// Events and limits of plausibility.
#include "rt_core/tissue/description/event_log.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "rt_core/tissue/description/limits.hpp"

namespace cellmirror::tissue {
namespace {

using Eigen::Vector3d;

TEST(EventLog, numbers_counts_and_keeps_the_last_ones) {
  EventLog log;
  for (std::uint64_t i = 1; i <= 100; ++i) {
    log.begin_step(Timestamp{static_cast<std::int64_t>(i)}, i);
    log.add(TissueEventKind::grip, {.instrument = 2, .object = 1, .part = "cystic artery"}, Vector3d(1, 2, 3), 0.5);
    EXPECT_EQ(log.of_step().size(), 1U);
    log.end_step();
  }
  EXPECT_EQ(log.counts()[0], 100U);
  std::vector<TissueEvent> last;
  log.last(last);
  ASSERT_EQ(last.size(), EventLog::kKept);
  EXPECT_EQ(last.front().number, 37U);
  EXPECT_EQ(last.back().number, 100U);
  EXPECT_EQ(last.back().time.ns, 100);
  EXPECT_EQ(std::string(last.back().part.data()), "cystic artery");
  EXPECT_EQ(last.back().instrument, 2);
}

TEST(EventLog, what_commands_cause_between_steps_belongs_to_the_next_one) {
  EventLog log;
  log.begin_step(Timestamp{1}, 1);
  log.add(TissueEventKind::grip, {}, Vector3d::Zero(), 0);
  log.end_step();
  log.add(TissueEventKind::release, {}, Vector3d::Zero(), 0);
  log.begin_step(Timestamp{2}, 2);
  ASSERT_EQ(log.of_step().size(), 1U);
  EXPECT_EQ(log.of_step()[0].kind, TissueEventKind::release);
}

TEST(EventLog, a_long_name_is_cut_and_ends) {
  EventLog log;
  log.begin_step(Timestamp{1}, 1);
  log.add(TissueEventKind::clip, {.part = "a name that is longer than an event has room for"}, Vector3d::Zero(), 0);
  EXPECT_EQ(std::string(log.of_step()[0].part.data()).size(), 23U);
}

TEST(Limits, count_and_report_at_most_once_a_second) {
  EventLog log;
  Limits limits;
  const auto report = static_cast<std::uint8_t>(TissueLimitAction::report);
  limits.set(TissueLimit::strain, report, 0.5);
  for (std::uint64_t i = 1; i <= 2500; ++i) {
    log.begin_step(Timestamp{static_cast<std::int64_t>(i)}, i);
    EXPECT_FALSE(limits.examine(TissueLimit::strain, 0.5, log, {.object = 0}, Vector3d::Zero()).any()) << "not beyond";
    EXPECT_TRUE(limits.examine(TissueLimit::strain, 0.6, log, {.object = 0}, Vector3d::Zero()).any());
    log.end_step();
  }
  EXPECT_EQ(limits.excesses()[5], 2500U);
  EXPECT_EQ(log.counts()[9], 3U);
}

TEST(Limits, are_off_with_no_action_or_a_value_that_is_not_positive) {
  EventLog log;
  log.begin_step(Timestamp{1}, 1);
  Limits limits;
  for (const double value : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    limits.set(TissueLimit::contact_force, 1, value);
    EXPECT_FALSE(limits.examine(TissueLimit::contact_force, 1e9, log, {}, Vector3d::Zero()).any());
  }
  limits.set(TissueLimit::contact_force, 0, 1.0);
  EXPECT_FALSE(limits.examine(TissueLimit::contact_force, 1e9, log, {}, Vector3d::Zero()).any());
  EXPECT_EQ(limits.excesses()[2], 0U);
}

}  // namespace
}  // namespace cellmirror::tissue
