// How runs of SCRIPT files are ended from outside, and how many there may be.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/unit/scripts/script_runner_fixture.hpp"

namespace cellmirror::script {
namespace {

TEST_F(ScriptRunnerTest, AProgramThatAStoppedScriptWasLoadingIsToldWhenItTurnsOutWrong) {
  write("a.spt", "\nTF_LOAD r3demo PUMA_762;\nTF_RUN r3demo PUMA_762;");
  gateway_.activity = std::make_shared<Activity>();
  const auto id = sut_->start_file("a");
  ASSERT_TRUE(id);
  run_all();
  ASSERT_TRUE(sut_->stop(*id));
  EXPECT_EQ(sut_->counters().file.received, 1U);
  EXPECT_EQ(sut_->counters().file.done, 0U);
  gateway_.activity->refuse({"programs/r3demo.ird has 1 error", {}});
  run_all();
  EXPECT_EQ(sut_->counters().file.refused, 1U);
  EXPECT_EQ(refused_.errors(), 1U);
  ASSERT_FALSE(sut_->last_errors().empty());
  EXPECT_NE(sut_->last_errors().back().find("scripts/a.spt:2:1: error: programs/r3demo.ird has 1 error"),
            std::string::npos);
}

TEST_F(ScriptRunnerTest, AMoveThatAStoppedScriptBeganGoesOn) {
  write("a.spt", "POS_ROB PUMA_762 JOINT_ABS 1;");
  gateway_.activity = std::make_shared<Activity>();
  const auto id = sut_->start_file("a");
  ASSERT_TRUE(id);
  run_all();
  ASSERT_TRUE(sut_->stop(*id));
  gateway_.activity->refuse({"superseded", {}});
  run_all();
  EXPECT_EQ(sut_->counters().file.done, 1U);
  EXPECT_TRUE(sut_->last_errors().empty());
}

TEST_F(ScriptRunnerTest, SendersThatWaitAreAnsweredWhenEverythingEnds) {
  gateway_.activity = std::make_shared<Activity>();
  std::vector<Result<std::string>> answers;
  sut_->execute_message("POS_ROB PUMA_762 JOINT_ABS 1", "message",
                        [&](const Result<std::string>& answer) { answers.push_back(answer); });
  sut_->stop_all();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0]);
}

TEST_F(ScriptRunnerTest, RefusesMoreRunsThanAllowed) {
  write("a.spt", "WAIT; WAIT;");
  gateway_.busy_checks = 1 << 30;
  for (std::size_t i = 0; i < ScriptRunner::kMaxRuns; ++i) ASSERT_TRUE(sut_->start_file("a"));
  EXPECT_FALSE(sut_->start_file("a"));
  EXPECT_FALSE(sut_->execute_message("EXEC_SCRIPT a"));
  sut_->stop_all();
  EXPECT_TRUE(sut_->idle());
  EXPECT_EQ(reports_.size(), ScriptRunner::kMaxRuns);
  EXPECT_TRUE(reports_[0].stopped);
}

TEST_F(ScriptRunnerTest, OneRunCanBeStopped) {
  write("a.spt", "DRAW_SCENE;DRAW_SCENE;");
  const auto first = sut_->start_file("a");
  const auto second = sut_->start_file("a");
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(sut_->stop(*first));
  EXPECT_FALSE(sut_->stop(*first));
  run_all();
  EXPECT_EQ(gateway_.calls.size(), 2U);
}

TEST_F(ScriptRunnerTest, StopAllEndsEveryRunAndStopsEveryRobot) {
  write("a.spt", "WAIT; DRAW_SCENE;");
  gateway_.busy_checks = 1 << 30;
  ASSERT_TRUE(sut_->start_file("a"));
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  const auto answer = sut_->execute_message("STOP_ALL");
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(*answer, "2 SCRIPT files stopped");
  EXPECT_EQ(times_all_stopped_, 1);
  EXPECT_TRUE(sut_->idle());
  ASSERT_EQ(reports_.size(), 2U);
  EXPECT_TRUE(reports_[0].stopped && reports_[1].stopped);
  for (const char* call : {"stop_programs PUMA_762", "stop PUMA_762"}) {
    EXPECT_NE(std::find(gateway_.calls.begin(), gateway_.calls.end(), call), gateway_.calls.end()) << call;
  }
  EXPECT_TRUE(sut_->execute_message("EXEC_SCRIPT a"));  // its place is free at once
}

TEST_F(ScriptRunnerTest, AScriptThatStopsAllEndsItselfBeforeItsNextCommand) {
  write("a.spt", "STOP_ALL; DRAW_SCENE;");
  write("b.spt", "hot_message b; WAIT;");
  gateway_.busy_checks = 1 << 30;
  ASSERT_TRUE(sut_->start_file("b"));
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  EXPECT_TRUE(sut_->idle());
  EXPECT_EQ(std::count(gateway_.calls.begin(), gateway_.calls.end(), "draw_scene"), 0);
  ASSERT_EQ(reports_.size(), 2U);
  EXPECT_EQ(sut_->counters().file.refused, 0U);
}

TEST_F(ScriptRunnerTest, ARunawayFamilyOfScriptsCanBeStopped) {
  write("outer.spt", "EXEC_SCRIPT inner; EXEC_SCRIPT inner; EXEC_SCRIPT inner;");
  std::string inner;
  for (int i = 0; i < 2000; ++i) inner += "DRAW_SCENE;";
  write("inner.spt", inner);
  for (std::size_t i = 0; i < ScriptRunner::kMaxRunsOfMessages; ++i)
    ASSERT_TRUE(sut_->execute_message("EXEC_SCRIPT outer"));
  sut_->step(256);
  ASSERT_TRUE(sut_->execute_message("STOP_SCRIPT 3"));
  EXPECT_EQ(sut_->runs().size(), ScriptRunner::kMaxRunsOfMessages - 1);
  const auto unknown = sut_->execute_message("STOP_SCRIPT 3");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().what.find("there is no run 3"), std::string::npos);
  ASSERT_TRUE(sut_->execute_message("STOP_ALL"));
  EXPECT_TRUE(sut_->idle());
}

TEST_F(ScriptRunnerTest, MessagesLeavePlacesToThePageAndBothToFootSwitches) {
  write("a.spt", "WAIT;");
  gateway_.busy_checks = 1 << 30;
  const auto start = [&](CommandSource::Kind from) { return sut_->execute_message("EXEC_SCRIPT a", "test", from); };
  for (std::size_t i = 0; i < ScriptRunner::kMaxRunsOfMessages; ++i) ASSERT_TRUE(start(CommandSource::Kind::message));
  const auto refused = start(CommandSource::Kind::message);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().remedy.find("STOP_ALL"), std::string::npos);
  for (std::size_t i = 0; i < ScriptRunner::kMaxRunsOfPage; ++i) ASSERT_TRUE(start(CommandSource::Kind::page));
  EXPECT_FALSE(start(CommandSource::Kind::page));
  EXPECT_TRUE(sut_->start_file("a"));
}

TEST_F(ScriptRunnerTest, AWithheldCommandIsPassedOverInAFileAndRefusedAsAMessage) {
  sut_.emplace(gateway_.host(), *home_, clock_,
               ScriptRunner::Events{.refused = [this](const Diagnostics& findings) { refused_.take(findings); },
                                    .withheld =
                                        [](FormId command, CommandSource::Kind /*from*/) {
                                          return command == FormId::robact ? std::optional(Error{"not here", {}})
                                                                           : std::nullopt;
                                        }});
  write("a.spt", "ROBACT PUMA_762;\nhot_message one;\n");
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  EXPECT_EQ(gateway_.calls, Calls{"show_message [one]"});
  EXPECT_TRUE(refused_.ok());
  const auto refused = sut_->execute_message("ROBACT PUMA_762");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "not here");
  EXPECT_TRUE(sut_->execute_message("hot_message two"));
}

}  // namespace
}  // namespace cellmirror::script
