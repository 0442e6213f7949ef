// What the log of commands gets: every command once, with its source, its text and what became of it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/log.hpp"
#include "scripts/runner/script_runner.hpp"
#include "tests/golden/scripts/quiet_host.hpp"
#include "tests/golden/scripts/recording_host.hpp"

namespace cellmirror::script {
namespace {

namespace fs = std::filesystem;

class CommandTraces : public ::testing::Test {
 protected:
  CommandTraces() {
    set_log_level(LogLevel::error);
    folder_ = fs::temp_directory_path() / ("cellmirror_traces_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "scripts");
    home_.emplace(KismetHome::open(folder_).value());
    sut_.emplace(gateway_.host(), *home_, clock_,
                 ScriptRunner::Events{.traced = [this](CommandTrace&& trace) { traces_.push_back(std::move(trace)); }});
  }
  ~CommandTraces() override { fs::remove_all(folder_); }

  void run(const std::string& text) {
    std::ofstream(folder_ / "scripts" / "a.spt", std::ios::binary) << text;
    const auto started = sut_->start_file("a");
    ASSERT_TRUE(started) << started.error().text();
    while (sut_->step(1000) != 0) {
    }
  }

  fs::path folder_;
  std::optional<KismetHome> home_;
  ManualClock clock_;
  cellmirror::testing::RecordingHost gateway_;
  std::vector<CommandTrace> traces_;
  std::optional<ScriptRunner> sut_;
};

TEST_F(CommandTraces, OfMessagesWithAndWithoutAnAnswer) {
  int answers = 0;
  sut_->execute({"ROBACT PUMA_762", CommandSource::message(12, 1000),
                 [&](const Result<std::string>& result) { answers += result ? 1 : 0; }});
  sut_->execute({"ROBACT nobody", CommandSource::page(3, "uid 7"), {}});
  EXPECT_EQ(answers, 1);
  ASSERT_EQ(traces_.size(), 2U);
  EXPECT_EQ(traces_[0].text, "ROBACT PUMA_762");
  EXPECT_EQ(traces_[0].source.kind, CommandSource::Kind::message);
  EXPECT_EQ(traces_[0].source.process, 12);
  EXPECT_EQ(traces_[0].source.user, 1000U);
  EXPECT_TRUE(traces_[0].done);
  EXPECT_EQ(traces_[1].source.session, 3U);
  EXPECT_EQ(traces_[1].source.peer, "uid 7");
  EXPECT_FALSE(traces_[1].done);
  EXPECT_NE(traces_[1].answer.find("nobody"), std::string::npos);
}

TEST_F(CommandTraces, OfFilesWithTheirLines) {
  run("# a comment\nROBACT PUMA_762;\n\n# another\nROBACT nobody ; WAIT;\n");
  ASSERT_EQ(traces_.size(), 3U);
  EXPECT_EQ(traces_[0].text, "ROBACT PUMA_762");
  EXPECT_EQ(traces_[0].source.place, "scripts/a.spt:2");
  EXPECT_EQ(traces_[0].source.kind, CommandSource::Kind::file);
  EXPECT_NE(traces_[0].run, 0U);
  EXPECT_TRUE(traces_[0].done);
  EXPECT_EQ(traces_[1].text, "ROBACT nobody");
  EXPECT_EQ(traces_[1].source.place, "scripts/a.spt:5");
  EXPECT_FALSE(traces_[1].done);
  EXPECT_FALSE(traces_[1].answer.empty());
  EXPECT_EQ(traces_[2].text, "WAIT");
  EXPECT_TRUE(traces_[2].done);
}

TEST_F(CommandTraces, OfCommandsInRobotPrograms) {
  EXPECT_TRUE(sut_->execute_program_command("ROBACT PUMA_762", "K1/BOX.src:12"));
  EXPECT_FALSE(sut_->execute_program_command("WAIT", "K1/BOX.src:13"));
  ASSERT_EQ(traces_.size(), 2U);
  EXPECT_EQ(traces_[0].source.kind, CommandSource::Kind::program);
  EXPECT_EQ(traces_[0].source.place, "K1/BOX.src:12");
  EXPECT_TRUE(traces_[0].done);
  EXPECT_FALSE(traces_[1].done);
}

TEST_F(CommandTraces, OfAMessageThatWaitsWhenTheGatewayEnds) {
  {
    CommandReply unanswered = [](const Result<std::string>&) {};
    sut_->execute({"TF_WAIT PUMA_762", CommandSource::message(12), std::move(unanswered)});
  }
  sut_->stop_all();
  sut_.reset();
  ASSERT_EQ(traces_.size(), 1U) << "once, whatever became of it";
}

}  // namespace
}  // namespace cellmirror::script
