// Alarms over a restart: what the file keeps, and what is refused in one that others wrote.
#include "app/alarms/alarm_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/alarms/alarm_line.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::SizeIs;

class AlarmLogTest : public testing::Test {
 protected:
  AlarmLogTest() : folder_(fs::temp_directory_path() / ("cellmirror-alarms-" + std::to_string(getpid()))) {
    set_log_level(LogLevel::error);
    fs::create_directories(folder_);
  }
  ~AlarmLogTest() override {
    sut_.reset();
    fs::remove_all(folder_);
  }
  [[nodiscard]] fs::path file() const { return folder_ / "a.jsonl"; }
  void start() {
    sut_.emplace(AlarmLog::Options{.file = file(), .no_file = {}}, clock_);
    sut_->start([this]() -> std::vector<AlarmCondition> {
      if (!active_.load()) return {};
      return {{.kind = "loop",
               .subject = "loop",
               .text = "the loop stood still",
               .priority = AlarmPriority::high,
               .off_delay = {}}};
    });
  }
  // Waits with patience: the thread looks several times a second.
  template <class Predicate>
  AlarmReport until(Predicate holds) {
    for (int i = 0; i < 1000; ++i) {
      AlarmReport report = sut_->report();
      if (holds(report)) return report;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ADD_FAILURE() << "it did not come";
    return sut_->report();
  }
  void write(const std::string& text) const { std::ofstream(file(), std::ios::binary) << text; }

  SystemClock clock_;
  fs::path folder_;
  std::atomic<bool> active_ = true;
  std::optional<AlarmLog> sut_;
};

TEST_F(AlarmLogTest, OutlivesARestart) {
  start();
  until([](const AlarmReport& report) { return report.open.size() == 1; });
  ASSERT_TRUE(sut_->acknowledged("Ada", 1));
  active_ = false;
  const AlarmReport before = until([](const AlarmReport& report) { return report.history.size() == 1; });
  active_ = true;
  const AlarmReport again = until([](const AlarmReport& report) { return report.open.size() == 1; });
  sut_.reset();
  struct stat info{};
  ASSERT_EQ(::stat(file().c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777U, 0600U);
  sut_.emplace(AlarmLog::Options{.file = file(), .no_file = {}}, clock_);
  EXPECT_EQ(sut_->report().history, before.history);
  EXPECT_EQ(sut_->report().open, again.open);
  EXPECT_EQ(sut_->report().refused_lines, 0U);
}

TEST_F(AlarmLogTest, RefusesWrongLinesOneByOne) {
  const Alarm good{.id = 3,
                   .kind = "near",
                   .subject = "A",
                   .text = "t",
                   .first_ms = 5,
                   .raised_ms = 6,
                   .cleared_ms = std::nullopt,
                   .acknowledged_ms = std::nullopt,
                   .acknowledged_by = {}};
  Alarm later = good;
  later.cleared_ms = 9;
  write("not JSON\n[]\n{\"id\":1}\n" + alarm_line_of(good) + "\n" + std::string(10'000, 'x') + "\n" +
        alarm_line_of(later) + "\nhalf a l");
  sut_.emplace(AlarmLog::Options{.file = file(), .no_file = {}}, clock_);
  const AlarmReport report = sut_->report();
  ASSERT_THAT(report.open, SizeIs(1));
  EXPECT_EQ(report.open[0], later) << "the last line of an alarm counts";
  EXPECT_EQ(report.refused_lines, 5U);
}

TEST_F(AlarmLogTest, DoesNotFollowALink) {
  std::ofstream(folder_ / "other") << "mine";
  fs::create_symlink(folder_ / "other", file());
  start();
  EXPECT_THAT(until([](const AlarmReport& report) { return !report.problem.empty(); }).problem,
              HasSubstr("cannot be written"));
  sut_.reset();
  EXPECT_EQ(fs::file_size(folder_ / "other"), 4U);
}

TEST_F(AlarmLogTest, WritesALongFileAnew) {
  Alarm alarm{.id = 1,
              .kind = "near",
              .subject = "A",
              .text = std::string(300, 't'),
              .first_ms = 5,
              .raised_ms = 6,
              .cleared_ms = 7,
              .acknowledged_ms = 8,
              .acknowledged_by = "Ada"};
  std::string text;
  while (text.size() < AlarmLog::kMostFileBytes) {
    text += alarm_line_of(alarm) + "\n";
    ++alarm.id;
  }
  write(text);
  start();
  until([](const AlarmReport& report) { return report.open.size() == 1; });
  sut_.reset();
  EXPECT_LT(fs::file_size(file()), AlarmLog::kMostFileBytes / 4);
  sut_.emplace(AlarmLog::Options{.file = file(), .no_file = {}}, clock_);
  EXPECT_THAT(sut_->report().history, SizeIs(AlarmList::kMostHistory));
  EXPECT_THAT(sut_->report().open, SizeIs(1));
}

TEST_F(AlarmLogTest, GoesOnWithoutAFileAndSaysSo) {
  sut_.emplace(AlarmLog::Options{.file = std::nullopt, .no_file = "there is no folder"}, clock_);
  EXPECT_EQ(sut_->problem(), "there is no folder");
  EXPECT_EQ(sut_->acknowledged("Ada", 0), "0 alarms acknowledged");
}

TEST(AlarmLine, ReadsWhatItWrites) {
  const Alarm alarm{.id = 12,
                    .kind = "collision",
                    .subject = "A \xE2\x80\x93 B",
                    .text = "\"A\" \\ and <b>",
                    .priority = AlarmPriority::high,
                    .occurrences = 4,
                    .first_ms = 1,
                    .raised_ms = 2,
                    .cleared_ms = 3,
                    .acknowledged_ms = 4,
                    .acknowledged_by = "\xC3\x85sa"};
  EXPECT_EQ(read_alarm_line(alarm_line_of(alarm)), alarm);
}

TEST(AlarmLine, RefusesWhatAnAlarmCannotHave) {
  const std::string good = alarm_line_of({.id = 1,
                                          .kind = "k",
                                          .subject = "s",
                                          .text = "t",
                                          .first_ms = 1,
                                          .raised_ms = 1,
                                          .cleared_ms = {},
                                          .acknowledged_ms = {},
                                          .acknowledged_by = {}});
  ASSERT_TRUE(read_alarm_line(good));
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string line = good;
    line.replace(line.find(what), what.size(), instead);
    return read_alarm_line(line).has_value();
  };
  for (const auto& [what, instead] : std::vector<std::pair<std::string, std::string>>{
           {"\"id\":1", "\"id\":0"},
           {"\"id\":1", "\"id\":-1"},
           {"\"id\":1", "\"id\":1.5"},
           {"\"id\":1", "\"id\":99999999999999"},
           {"\"kind\":\"k\"", "\"kind\":\"\""},
           {"\"kind\":\"k\"", "\"kind\":null"},
           {"\"text\":\"t\"", "\"text\":\"a\\nb\""},
           {"\"text\":\"t\"", "\"text\":\"" + std::string(500, 'x') + "\""},
           {"\"priority\":\"low\"", "\"priority\":\"worst\""},
           {"\"first_ms\":1", "\"first_ms\":\"1\""},
           {"\"first_ms\":1,", ""},
           {"\"raised_ms\":1", "\"raised_ms\":300000000000000"},
           {"\"acknowledged_ms\":null", "\"acknowledged_ms\":5"},
           {"\"acknowledged_by\":\"\"", "\"acknowledged_by\":\"Ada\""}}) {
    EXPECT_FALSE(with(what, instead)) << instead;
  }
}

}  // namespace
}  // namespace cellmirror::app
