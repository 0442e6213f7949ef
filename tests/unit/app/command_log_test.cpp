#include "app/io/command_log.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/log.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;

class CommandLogTest : public testing::Test {
 protected:
  CommandLogTest() : folder_(fs::temp_directory_path() / ("cellmirror-commands-" + std::to_string(getpid()))) {
    set_log_level(LogLevel::error);
    fs::create_directories(folder_);
    sut_.emplace(options_);
  }
  ~CommandLogTest() override {
    sut_.reset();
    fs::remove_all(folder_);
  }

  static CommandRecord record(const std::string& command) {
    return {.wall_ns = 1'795'420'800'123'456'789,
            .took_s = 0.25,
            .source = "message",
            .process = 12,
            .user = 1000,
            .place = {},
            .command = command,
            .done = true,
            .answer = {}};
  }
  // All that was added before is in the file then.
  void restart() {
    sut_.reset();
    sut_.emplace(options_);
  }
  [[nodiscard]] std::vector<nlohmann::json> lines(const std::string& name = "c.jsonl") const {
    std::vector<nlohmann::json> out;
    std::ifstream in(folder_ / name);
    for (std::string line; std::getline(in, line);) out.push_back(nlohmann::json::parse(line));
    return out;
  }
  static unsigned mode_of(const fs::path& file) {
    struct stat info{};
    return ::lstat(file.c_str(), &info) == 0 ? info.st_mode & 07777u : 0;
  }

  fs::path folder_;
  CommandLog::Options options_{.file = folder_ / "c.jsonl", .most_bytes = 4096, .old_files = 2};
  std::optional<CommandLog> sut_;
};

TEST_F(CommandLogTest, AnEntryHasWhoWhenWhatAndTheOutcome) {
  EXPECT_EQ(command_line_of(record("ROBACT X")),
            R"({"time":"2026-11-23T08:00:00.123Z","took_s":0.250000,"source":"message","process":12,"user":1000,)"
            R"("command":"ROBACT X","outcome":"done"})");
  CommandRecord refused = record("NO\xff\n");
  refused.source = "page";
  refused.process = 0;
  refused.user.reset();
  refused.session = 3;
  refused.peer = "uid 1000";
  refused.done = false;
  refused.answer = "why";
  const auto read = nlohmann::json::parse(command_line_of(refused));
  EXPECT_EQ(read["session"], 3);
  EXPECT_EQ(read["peer"], "uid 1000");
  EXPECT_EQ(read["outcome"], "refused");
  EXPECT_EQ(read["answer"], "why");
  EXPECT_FALSE(read.contains("process"));
  EXPECT_EQ(command_line_of(refused).find('\n'), std::string::npos) << "one line whatever the command holds";
}

TEST_F(CommandLogTest, IsReadableForItsOwnerOnlyAndKeptOverRestarts) {
  sut_->add(record("A"));
  restart();
  sut_->add(record("B"));
  restart();
  const auto read = lines();
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0]["command"], "A");
  EXPECT_EQ(read[1]["command"], "B");
  EXPECT_EQ(mode_of(options_.file), 0600U);
  const CommandLogReport report = sut_->report();
  ASSERT_EQ(report.last.size(), 2U) << "those from before the restart";
  EXPECT_EQ(nlohmann::json::parse(report.last[1])["command"], "B");
  EXPECT_EQ(report.problem, "");
}

TEST_F(CommandLogTest, IsBoundedInSizeAndInNumberOfFiles) {
  for (int i = 0; i < 40; ++i) {
    sut_->add(record("POS_ROB " + std::string(400, 'x') + std::to_string(i)));
    if (i % 4 == 3) restart();  // so that they are not written in one piece
  }
  restart();
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_LE(entry.file_size(), options_.most_bytes) << entry.path();
    EXPECT_EQ(mode_of(entry.path()), 0600U);
    ++files;
  }
  EXPECT_EQ(files, 3U);
  const auto newest = lines();
  ASSERT_FALSE(newest.empty());
  EXPECT_TRUE(newest.back()["command"].get<std::string>().ends_with("x39"));
  EXPECT_FALSE(lines("c.jsonl.2").empty());
}

TEST_F(CommandLogTest, KeepsTheNewestForTheReport) {
  for (std::size_t i = 0; i < CommandLog::kKept + 10; ++i) sut_->add(record(std::to_string(i)));
  restart();
  const CommandLogReport report = sut_->report();
  EXPECT_LE(report.last.size(), CommandLog::kKept);
  ASSERT_FALSE(report.last.empty());
  EXPECT_EQ(nlohmann::json::parse(report.last.back())["command"], std::to_string(CommandLog::kKept + 9));
}

TEST_F(CommandLogTest, ALinkInItsPlaceIsNotFollowed) {
  sut_.reset();
  std::ofstream(folder_ / "target") << "mine";
  fs::remove(options_.file);
  fs::create_symlink(folder_ / "target", options_.file);
  sut_.emplace(options_);
  sut_->add(record("A"));
  for (int i = 0; i < 5000 && sut_->report().problem.empty(); ++i) ::usleep(1000);
  EXPECT_NE(sut_->report().problem.find("cannot be written"), std::string::npos);
  EXPECT_EQ(sut_->report().dropped, 1U);
  std::ifstream in(folder_ / "target");
  std::string text;
  in >> text;
  EXPECT_EQ(text, "mine");
  fs::remove(options_.file);
  sut_->add(record("B"));
  for (int i = 0; i < 5000 && !sut_->report().problem.empty(); ++i) ::usleep(1000);
  EXPECT_EQ(sut_->report().problem, "") << "it recovers";
  const auto read = lines();
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0]["command"], "B");
  EXPECT_EQ(read[1]["dropped"], 1) << "what is missing is noted";
}

// A limit of file sizes stands for a full disk.
TEST_F(CommandLogTest, AFullDiskLeavesNoHalfLine) {
  sut_->add(record("A"));
  restart();
  const auto before = fs::file_size(options_.file);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const rlimit small{before + 10, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  sut_->add(record("B"));
  for (int i = 0; i < 5000 && sut_->report().problem.empty(); ++i) ::usleep(1000);
  EXPECT_NE(sut_->report().problem.find("make room"), std::string::npos) << sut_->report().problem;
  EXPECT_EQ(fs::file_size(options_.file), before);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  sut_->add(record("C"));
  restart();
  EXPECT_EQ(lines()[1]["command"], "C");
}

TEST_F(CommandLogTest, AddingNeverWaitsAndWhatIsTooMuchIsCounted) {
  constexpr std::size_t kMany = 3 * CommandLog::kMostWaiting;
  options_.most_bytes = std::uint64_t{1} << 24;
  restart();
  for (std::size_t i = 0; i < kMany; ++i) sut_->add(record("X"));
  for (int i = 0; i < 10'000 && sut_->report().written + sut_->report().dropped < kMany; ++i) ::usleep(1000);
  const CommandLogReport report = sut_->report();
  EXPECT_EQ(report.written + report.dropped, kMany);
  EXPECT_GE(report.written, CommandLog::kMostWaiting);
}

TEST_F(CommandLogTest, AScriptThatFloodsTheLogTakesNoPlaceOfAPersonsCommand) {
  options_.most_bytes = std::uint64_t{1} << 24;
  restart();
  CommandRecord of_file = record("DRAW_SCENE");
  of_file.source = "file";
  std::size_t sent = 0;
  for (; sent < 100 * CommandLog::kMostWaiting && sut_->report().dropped < 10; ++sent) sut_->add(of_file);
  ASSERT_GE(sut_->report().dropped, 10U) << "the script was not faster than the log";
  const std::uint64_t dropped = sut_->report().dropped;
  sut_->add(record("STOP_ALL"));
  EXPECT_EQ(sut_->report().dropped, dropped);
  sut_.reset();
  const auto read = lines();
  EXPECT_TRUE(std::ranges::any_of(read, [](const auto& line) { return line.value("command", "") == "STOP_ALL"; }));
}

TEST_F(CommandLogTest, ACutTextStaysText) {
  sut_->add(record(std::string(CommandLog::kMostTextBytes - 1, 'a') + "\xc3\xa4"));
  sut_.reset();
  EXPECT_EQ(lines()[0]["command"], std::string(CommandLog::kMostTextBytes - 1, 'a'));
}

TEST_F(CommandLogTest, NoiseInTheFileIsNotShown) {
  sut_.reset();
  std::ofstream(options_.file, std::ios::binary) << "\xff\xfe{\n[1]\n{\"command\":\"A\"}\n{\"half";
  sut_.emplace(options_);
  EXPECT_EQ(sut_->report().last, std::vector<std::string>{R"({"command":"A"})"});
  sut_->add(record("B"));
  sut_.reset();
  std::ifstream in(options_.file);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(text.find("{\"half\n{\"time\""), std::string::npos) << "the next entry begins a line";
}

}  // namespace
}  // namespace cellmirror::app
