// Files and messages run side by side; whatever is wrong is refused with its reason and the rest goes on.
#include "scripts/runner/script_runner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "rt_core/base/capacity.hpp"
#include "scripts/lang/reader.hpp"
#include "tests/golden/scripts/quiet_host.hpp"
#include "tests/unit/scripts/script_runner_fixture.hpp"

namespace cellmirror::script {
namespace {

TEST_F(ScriptRunnerTest, ExecutesAMessageAtOnce) {
  const auto answer = sut_->execute_message("ROBACT PUMA_762");
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(*answer, "");
  EXPECT_EQ(gateway_.calls, Calls{"set_active_robot PUMA_762"});
  EXPECT_EQ(sut_->counters().message.received, 1U);
  EXPECT_EQ(sut_->counters().message.done, 1U);
}

TEST_F(ScriptRunnerTest, RefusesAMessageWithAllItsMistakes) {
  const auto answer = sut_->execute_message("SET_CAMPAR CAMERA_9 -1 20");
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().what,
            "SET_CAMPAR: there is no camera CAMERA_9 | SET_CAMPAR: focal distance -1 is not more than 0 m");
  EXPECT_EQ(answer.error().remedy, "did you mean CAMERA_5?");
  EXPECT_EQ(sut_->counters().message.refused, 1U);
  EXPECT_TRUE(gateway_.calls.empty());
}

TEST_F(ScriptRunnerTest, PassesOnTheGatewaysRefusal) {
  gateway_.refused_call = "connect";
  const auto answer = sut_->execute_message("CONNECT Toolbox.Tool1 TO Mantec_1.HAND");
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().what, "the test refuses connect Toolbox.Tool1 to Mantec_1.HAND");
  ASSERT_EQ(sut_->last_errors().size(), 1U);
  EXPECT_NE(sut_->last_errors()[0].find("message:1:1: error: the test refuses connect"), std::string::npos);
}

TEST_F(ScriptRunnerTest, AnswersWithTheGatewaysRemark) {
  gateway_.draw_mode_remark = "nothing is seen of it";
  const auto answer = sut_->execute_message("SET_FRAME Toolbox.Tool1 RENDER 2");
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(*answer, "nothing is seen of it");
}

TEST_F(ScriptRunnerTest, RefusesWaitAsAMessageWithTheReason) {
  const auto answer = sut_->execute_message("WAIT");
  ASSERT_FALSE(answer);
  EXPECT_NE(answer.error().what.find("a message has none"), std::string::npos);
}

TEST_F(ScriptRunnerTest, RefusesNoiseAndEmptyMessages) {
  std::string noise(8192, '\0');
  std::uint32_t state = 1;
  for (char& c : noise) c = static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
  EXPECT_FALSE(sut_->execute_message(noise));
  EXPECT_FALSE(sut_->execute_message(""));
  EXPECT_FALSE(sut_->execute_message(std::string(8192, ';')));
  EXPECT_TRUE(sut_->execute_message("# a comment"));
  EXPECT_EQ(sut_->counters().message.received, 4U);
  EXPECT_EQ(sut_->counters().message.refused, 3U);
}

TEST_F(ScriptRunnerTest, ScriptStartedByMessageRunsOnItsOwn) {
  write("a.spt", "hot_message one;\nhot_message two;");
  const auto answer = sut_->execute_message("EXEC_SCRIPT a");
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(*answer, "scripts/a.spt started as run 1");
  EXPECT_TRUE(gateway_.calls.empty());
  EXPECT_EQ(sut_->step(1), 1U);
  EXPECT_TRUE(sut_->execute_message("hot_message between"));
  run_all();
  EXPECT_EQ(gateway_.calls, (Calls{"show_message [one]", "show_message [between]", "show_message [two]"}));
  ASSERT_EQ(reports_.size(), 1U);
  EXPECT_EQ(reports_[0].file, "scripts/a.spt");
  EXPECT_EQ(reports_[0].counters.done, 2U);
  EXPECT_TRUE(sut_->idle());
}

TEST_F(ScriptRunnerTest, CalledScriptRunsBeforeItsCallerGoesOn) {
  write("outer.spt", "EXEC_SCRIPT inner.spt; hot_message outer;");
  write("inner.spt", "hot_message inner");
  ASSERT_TRUE(sut_->start_file("outer.spt"));
  run_all();
  EXPECT_EQ(gateway_.calls, (Calls{"show_message [inner]", "show_message [outer]"}));
}

TEST_F(ScriptRunnerTest, RefusedCommandDoesNotStopTheScript) {
  write("a.spt", "DRAW_SCENE;\nROBACT nobody;\nVV_RELOAD_LUTS nothing;\nDRAW_SCENE;");
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  EXPECT_EQ(gateway_.calls, (Calls{"draw_scene", "draw_scene"}));
  ASSERT_EQ(reports_.size(), 1U);
  EXPECT_EQ(reports_[0].counters.received, 4U);
  EXPECT_EQ(reports_[0].counters.done, 2U);
  EXPECT_EQ(reports_[0].counters.refused, 2U);
  ASSERT_EQ(reports_[0].diagnostics.all().size(), 2U);
  EXPECT_EQ(reports_[0].diagnostics.all()[0].place.line, 2);
  EXPECT_EQ(reports_[0].diagnostics.all()[0].place.column, 8);
  EXPECT_EQ(reports_[0].diagnostics.all()[1].place.line, 3);
}

TEST_F(ScriptRunnerTest, ScriptWithSyntaxErrorsIsRefusedAsAWhole) {
  write("a.spt", "DRAW_SCENE;\nDRAW_SCEEN;\nROBACT;\n");
  Diagnostics findings;
  const auto started = sut_->start_file("a", &findings);
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().what.find("scripts/a.spt has 2 errors and is not run"), std::string::npos);
  EXPECT_EQ(findings.errors(), 2U);
  run_all();
  EXPECT_TRUE(gateway_.calls.empty());
  EXPECT_EQ(sut_->counters().scripts_refused, 1U);
}

TEST_F(ScriptRunnerTest, NamesAreLookedUpWhenTheirCommandIsExecuted) {
  write("a.spt", "hot_message first; SWAP_NODE Testlab_1.Neu;");
  ASSERT_TRUE(sut_->start_file("a"));
  ASSERT_EQ(sut_->step(1), 1U);
  gateway_.names.add(NameKind::frame_node, "Testlab_1.Neu");
  run_all();
  EXPECT_EQ(gateway_.calls.back(), "swap_node Testlab_1.Neu");
}

TEST_F(ScriptRunnerTest, WaitSuspendsOnlyItsOwnScript) {
  write("waits.spt", "hot_message before; WAIT; hot_message after;");
  write("other.spt", "hot_message other; hot_message other;");
  gateway_.busy_checks = 3;
  ASSERT_TRUE(sut_->start_file("waits"));
  ASSERT_TRUE(sut_->start_file("other"));
  run_all();
  EXPECT_FALSE(sut_->idle());
  ASSERT_EQ(sut_->runs().size(), 1U);
  EXPECT_TRUE(sut_->runs()[0].waiting);
  EXPECT_TRUE(sut_->execute_message("hot_message message"));
  gateway_.busy_checks = 0;
  run_all();
  EXPECT_EQ(gateway_.calls, (Calls{"show_message [before]", "show_message [other]", "show_message [other]",
                                   "show_message [message]", "show_message [after]"}));
  EXPECT_TRUE(sut_->idle());
}

TEST_F(ScriptRunnerTest, WaitIsRefusedAtItsPlaceWithTheProgramThatFailedSinceTheScriptBeganAndTheScriptGoesOn) {
  gateway_.failed = {"an older failure"};
  write("a.spt", "TF_RUN demo PUMA_762;\n  WAIT;\nhot_message on; WAIT;");
  gateway_.busy_checks = 1 << 30;
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  gateway_.failed.emplace_back("programs/demo.ird:3:1: error: out of reach");
  gateway_.busy_checks = 0;
  run_all();
  EXPECT_TRUE(sut_->idle());
  ASSERT_EQ(reports_.size(), 1U);
  ASSERT_EQ(reports_[0].diagnostics.all().size(), 1U) << reports_[0].diagnostics.text();
  EXPECT_EQ(reports_[0].diagnostics.all()[0].text(),
            "scripts/a.spt:2:3: error: programs/demo.ird:3:1: error: out of reach");
  EXPECT_EQ(gateway_.calls.back(), "show_message [on]");
  EXPECT_EQ(reports_[0].counters.done, 3U);  // the second WAIT too: nothing failed since the first
}

TEST_F(ScriptRunnerTest, CommandsOfRobotProgramsAreExecutedAtOnceAndCountedApart) {
  const auto done = sut_->execute_program_command("hot_message half way", "program demo of PUMA_762, line 12");
  ASSERT_TRUE(done);
  EXPECT_EQ(*done, nullptr);
  EXPECT_EQ(gateway_.calls.back(), "show_message [half way]");
  const auto refused = sut_->execute_program_command("hot_massage x", "program demo of PUMA_762, line 13");
  ASSERT_FALSE(refused);
  EXPECT_EQ(sut_->counters().program.received, 2U);
  EXPECT_EQ(sut_->counters().program.done, 1U);
  EXPECT_EQ(sut_->counters().program.refused, 1U);
  EXPECT_EQ(sut_->counters().all().received, 2U);
  EXPECT_EQ(sut_->counters().message.received, 0U);
  EXPECT_NE(sut_->last_errors().back().find("program demo of PUMA_762, line 13"), std::string::npos);
}

TEST_F(ScriptRunnerTest, ACommandOfARobotProgramThatGoesOnIsCountedWhenItHasEnded) {
  gateway_.activity = std::make_shared<Activity>();
  const auto begun = sut_->execute_program_command("POS_ROB PUMA_762 JOINT_ABS 1", "program demo");
  ASSERT_TRUE(begun);
  ASSERT_EQ(*begun, gateway_.activity);
  EXPECT_EQ(sut_->counters().program.done, 0U);
  gateway_.activity->finish();
  run_all();
  EXPECT_EQ(sut_->counters().program.done, 1U);
}

TEST_F(ScriptRunnerTest, ARobotProgramCannotWaitForPrograms) {
  for (const char* command : {"WAIT", "TF_WAIT PUMA_762"}) {
    const auto sut = sut_->execute_program_command(command, "program demo");
    ASSERT_FALSE(sut) << command;
    EXPECT_NE(sut.error().what.find("cannot wait for programs"), std::string::npos) << sut.error().what;
  }
  EXPECT_TRUE(gateway_.calls.empty());
}

TEST_F(ScriptRunnerTest, AScriptThatAProgramCallsRunsBesideIt) {
  write("a.spt", "hot_message from the program;");
  ASSERT_TRUE(sut_->execute_program_command("EXEC_SCRIPT a", "program demo"));
  EXPECT_FALSE(sut_->idle());
  run_all();
  EXPECT_EQ(gateway_.calls.back(), "show_message [from the program]");
}

TEST_F(ScriptRunnerTest, TfWaitSuspendsAFileAndKeepsAMessageWithoutItsAnswer) {
  write("a.spt", "TF_WAIT PUMA_762; hot_message ended;");
  gateway_.activity = std::make_shared<Activity>();
  ASSERT_TRUE(sut_->start_file("a"));
  std::optional<Result<std::string>> answer;
  sut_->execute_message("TF_WAIT PUMA_762", "message", [&](const Result<std::string>& result) { answer = result; });
  run_all();
  EXPECT_FALSE(sut_->idle());
  EXPECT_FALSE(answer);
  gateway_.activity->refuse({"the program failed", {}});
  run_all();
  EXPECT_TRUE(sut_->idle());
  ASSERT_TRUE(answer && !*answer);
  EXPECT_EQ(answer->error().what, "the program failed");
  ASSERT_EQ(reports_.size(), 1U);
  EXPECT_EQ(reports_[0].counters.refused, 1U);
}

TEST_F(ScriptRunnerTest, FileWaitsForWhatItsCommandBeganAndMessagesGoOn) {
  write("a.spt", "POS_ROB PUMA_762 JOINT_ABS 1; hot_message there;");
  gateway_.activity = std::make_shared<Activity>();
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  EXPECT_EQ(sut_->counters().file.received, 1U);
  EXPECT_EQ(sut_->counters().file.done, 0U);
  ASSERT_EQ(sut_->runs().size(), 1U);
  EXPECT_TRUE(sut_->runs()[0].waiting);
  EXPECT_TRUE(sut_->execute_message("hot_message meanwhile"));
  gateway_.activity->finish();
  run_all();
  EXPECT_TRUE(sut_->idle());
  EXPECT_EQ(sut_->counters().file.done, 2U);
  EXPECT_EQ(gateway_.calls.back(), "show_message [there]");
}

TEST_F(ScriptRunnerTest, WhatEndsBadlyIsRefusedAtThePlaceOfItsCommandAndTheFileGoesOn) {
  write("a.spt", "DRAW_SCENE;\n  POS_ROB PUMA_762 JOINT_ABS 1;\nhot_message on;");
  gateway_.activity = std::make_shared<Activity>();
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  gateway_.activity->refuse({"the robot was stopped", "start it again"});
  run_all();
  ASSERT_EQ(reports_.size(), 1U);
  EXPECT_EQ(reports_[0].counters.done, 2U);
  EXPECT_EQ(reports_[0].counters.refused, 1U);
  EXPECT_EQ(reports_[0].diagnostics.all()[0].text(), "scripts/a.spt:2:3: error: the robot was stopped; start it again");
  EXPECT_EQ(gateway_.calls.back(), "show_message [on]");
}

TEST_F(ScriptRunnerTest, LastCommandOfAFileIsWaitedForToo) {
  write("a.spt", "POS_ROB PUMA_762 JOINT_ABS 1");
  gateway_.activity = std::make_shared<Activity>();
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  EXPECT_TRUE(reports_.empty());
  gateway_.activity->finish();
  EXPECT_EQ(sut_->step(10), 1U);
  EXPECT_EQ(reports_.size(), 1U);
}

TEST_F(ScriptRunnerTest, SenderIsAnsweredWhenWhatWasBegunHasEnded) {
  gateway_.activity = std::make_shared<Activity>();
  std::vector<Result<std::string>> answers;
  const auto keep = [&](const Result<std::string>& answer) { answers.push_back(answer); };
  sut_->execute_message("POS_ROB PUMA_762 JOINT_ABS 1", "message", keep);
  EXPECT_EQ(sut_->step(10), 0U);
  EXPECT_TRUE(answers.empty());
  EXPECT_EQ(sut_->counters().message.done, 0U);
  gateway_.activity->finish();
  EXPECT_EQ(sut_->step(10), 1U);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0]);
  EXPECT_EQ(sut_->counters().message.done, 1U);
  EXPECT_EQ(sut_->step(10), 0U);
  EXPECT_EQ(answers.size(), 1U);
}

TEST_F(ScriptRunnerTest, SenderIsAnsweredAtOnceWhereThereIsNothingToWaitFor) {
  std::vector<Result<std::string>> answers;
  const auto keep = [&](const Result<std::string>& answer) { answers.push_back(answer); };
  sut_->execute_message("POS_ROB PUMA_762 JOINT_ABS 1", "message", keep);
  sut_->execute_message("ROBACT nobody", "message", keep);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_TRUE(answers[0]);
  EXPECT_FALSE(answers[1]);
}

TEST_F(ScriptRunnerTest, SenderLearnsWhyItDidNotComeToItsEnd) {
  gateway_.activity = std::make_shared<Activity>();
  std::vector<Result<std::string>> answers;
  const auto keep = [&](const Result<std::string>& answer) { answers.push_back(answer); };
  sut_->execute_message("POS_ROB PUMA_762 JOINT_ABS 1", "message from process 7", keep);
  gateway_.activity->refuse({"superseded", {}});
  sut_->step(10);
  ASSERT_EQ(answers.size(), 1U);
  ASSERT_FALSE(answers[0]);
  EXPECT_EQ(answers[0].error().what, "superseded");
  EXPECT_EQ(sut_->counters().message.refused, 1U);
  EXPECT_NE(sut_->last_errors().back().find("message from process 7:1:1: error: superseded"), std::string::npos);
}

TEST_F(ScriptRunnerTest, ProgramsThatNobodyWaitsForAreCountedAndRememberedWhenTheyTurnOutWrong) {
  for (const char* command : {"TF_LOAD r3demo PUMA_762", "TF_RUN r3demo PUMA_762", "TF_BACK r3demo PUMA_762"}) {
    const SourceCounters before = sut_->counters().message;
    gateway_.activity = std::make_shared<Activity>();
    ASSERT_TRUE(sut_->execute_message(command, "message from process 7"));
    EXPECT_EQ(sut_->counters().message.done, before.done) << command;
    gateway_.activity->refuse({"programs/r3demo.ird has 1 error", {}});
    sut_->step(10);
    EXPECT_EQ(sut_->counters().message.done, before.done) << command;
    EXPECT_EQ(sut_->counters().message.refused, before.refused + 1) << command;
    ASSERT_FALSE(sut_->last_errors().empty());
    EXPECT_NE(sut_->last_errors().back().find("message from process 7:1:1: error: programs/r3demo.ird has 1 error"),
              std::string::npos);
  }
  gateway_.activity = std::make_shared<Activity>();
  ASSERT_TRUE(sut_->execute_message("TF_LOAD r3demo PUMA_762"));
  gateway_.activity->finish();
  sut_->step(10);
  EXPECT_EQ(sut_->counters().message.done, 1U);
  EXPECT_EQ(sut_->counters().message.received, 4U);
}

TEST_F(ScriptRunnerTest, RunsTakeTurns) {
  std::string a;
  std::string b;
  for (std::size_t i = 0; i < 2 * ScriptRunner::kSlice; ++i) {
    a += "hot_message a;";
    b += "hot_message b;";
  }
  write("a.spt", a);
  write("b.spt", b);
  ASSERT_TRUE(sut_->start_file("a"));
  ASSERT_TRUE(sut_->start_file("b"));
  EXPECT_EQ(sut_->step(2 * ScriptRunner::kSlice), 2 * ScriptRunner::kSlice);
  EXPECT_EQ(std::count(gateway_.calls.begin(), gateway_.calls.end(), "show_message [a]"), ScriptRunner::kSlice);
  EXPECT_EQ(std::count(gateway_.calls.begin(), gateway_.calls.end(), "show_message [b]"), ScriptRunner::kSlice);
}

TEST_F(ScriptRunnerTest, StepKeepsToItsBudget) {
  write("a.spt", "DRAW_SCENE;DRAW_SCENE;DRAW_SCENE;DRAW_SCENE;");
  ASSERT_TRUE(sut_->start_file("a"));
  EXPECT_EQ(sut_->step(0), 0U);
  EXPECT_EQ(sut_->step(3), 3U);
  EXPECT_EQ(gateway_.calls.size(), 3U);
  EXPECT_EQ(sut_->step(3), 1U);
}

TEST_F(ScriptRunnerTest, StepEndsEarlyBehindALargeFile) {
  write("large.spt", std::string(1'000'000, '\n') + "DRAW_SCENE;");
  std::string calls;
  for (int i = 0; i < 50; ++i) calls += "EXEC_SCRIPT large;";
  write("a.spt", calls);
  ASSERT_TRUE(sut_->start_file("a"));
  EXPECT_EQ(sut_->step(1000), 1U);
  EXPECT_EQ(sut_->step(1000), 2U);
  run_all();
  EXPECT_EQ(gateway_.calls.size(), 50U);
}

TEST_F(ScriptRunnerTest, StepEndsEarlyWhereCommandsAreRefused) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "ROBACT nobody;";
  write("a.spt", text);
  ASSERT_TRUE(sut_->start_file("a"));
  EXPECT_LT(sut_->step(1000), 100U);
  run_all();
  EXPECT_EQ(sut_->counters().file.refused, 1000U);
}

TEST_F(ScriptRunnerTest, RefusesFilesThatItCannotOrMayNotRead) {
  fs::create_directories(folder_ / "scripts" / "folder.spt");
  fs::create_symlink("/etc/hostname", folder_ / "scripts" / "link.spt");
  write("closed.spt", "DRAW_SCENE;");
  fs::permissions(folder_ / "scripts" / "closed.spt", fs::perms::none);
  for (const char* name : {"missing", "folder.spt", "link.spt", "../../x.spt", "/etc/hostname"}) {
    const auto started = sut_->start_file(name);
    ASSERT_FALSE(started) << name;
    EXPECT_FALSE(started.error().what.empty());
  }
  if (geteuid() != 0) {
    EXPECT_FALSE(sut_->start_file("closed"));
  }
  EXPECT_TRUE(sut_->idle());
}

TEST_F(ScriptRunnerTest, OperatorsFileMayLieOutsideOfTheHome) {
  const fs::path outside = fs::temp_directory_path() / ("cellmirror_outside_" + std::to_string(getpid()) + ".spt");
  std::ofstream(outside) << "EXEC_SCRIPT inside; DRAW_SCENE;";
  write("inside.spt", "hot_message inside;");
  EXPECT_TRUE(sut_->start_path(outside));
  run_all();
  fs::remove(outside);
  EXPECT_EQ(gateway_.calls, (Calls{"show_message [inside]", "draw_scene"}));
  EXPECT_FALSE(sut_->start_path(outside));
}

TEST_F(ScriptRunnerTest, CallsEndAtTheDepthLimit) {
  for (std::size_t i = 0; i < kMaxScriptDepth + 5; ++i)
    write("d" + std::to_string(i) + ".spt",
          "hot_message " + std::to_string(i) + "; EXEC_SCRIPT d" + std::to_string(i + 1) + ";");
  ASSERT_TRUE(sut_->start_file("d0"));
  run_all();
  EXPECT_EQ(gateway_.calls.size(), kMaxScriptDepth);
  ASSERT_EQ(reports_.size(), 1U);
  EXPECT_EQ(reports_[0].counters.refused, 1U);
}

TEST_F(ScriptRunnerTest, LastErrorsAreBoundedAndDated) {
  for (std::size_t i = 0; i < ScriptRunner::kKeptErrors + 10; ++i)
    EXPECT_FALSE(sut_->execute_message("X" + std::to_string(i)));
  const auto errors = sut_->last_errors();
  ASSERT_EQ(errors.size(), ScriptRunner::kKeptErrors);
  EXPECT_NE(errors.back().find("X29"), std::string::npos);
  EXPECT_EQ(errors.back()[10], 'T');
  EXPECT_EQ(errors.back()[19], 'Z');
}

TEST_F(ScriptRunnerTest, CountersBalance) {
  write("a.spt", "DRAW_SCENE; ROBACT nobody; EXEC_SCRIPT b; EXEC_SCRIPT missing; WAIT;");
  write("b.spt", "EXEC_SCRIPT a; hot_message b;");
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  EXPECT_FALSE(sut_->execute_message("VV_RELOAD_LUTS nothing"));
  const ScriptCounters& counters = sut_->counters();
  EXPECT_EQ(counters.file.received, 7U);
  EXPECT_EQ(counters.file.done + counters.file.refused, counters.file.received);
  EXPECT_EQ(counters.file.refused, 3U);
  EXPECT_EQ(counters.all().received, 8U);
  EXPECT_EQ(counters.scripts_started, 1U);
  EXPECT_EQ(counters.scripts_ended, 1U);
  EXPECT_EQ(counters.scripts_refused, 2U);
}

TEST_F(ScriptRunnerTest, ScriptOfTenMegabytesRuns) {
  std::string text;
  std::size_t commands = 0;
  while (text.size() < 10'000'000) {
    text += "POS_ROB MANTEC_RM3 JOINT_ABS 27.5 -17.38 -11.02 37.338 0.9 -12.271;\n";
    ++commands;
  }
  write("big.spt", text);
  cellmirror::testing::QuietHost gateway;
  ScriptRunner sut(gateway.host(), *home_, clock_);
  ASSERT_TRUE(sut.start_file("big"));
  while (sut.step(10000) != 0) {
  }
  EXPECT_EQ(gateway.calls, commands);
  EXPECT_EQ(sut.counters().file.refused, 0U);
}

TEST_F(ScriptRunnerTest, ScriptBeyondTheLimitIsRefused) {
  write("huge.spt", "");
  fs::resize_file(folder_ / "scripts" / "huge.spt", kMaxScriptBytes + 1);
  const auto started = sut_->start_file("huge");
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().what.find("more than"), std::string::npos);
}

TEST_F(ScriptRunnerTest, AFileThatIsNoTextIsRefused) {
  write("binary.spt", std::string("\x7f"
                                  "ELF\0\0\0",
                                  7));
  EXPECT_FALSE(sut_->start_file("binary"));
}

TEST_F(ScriptRunnerTest, ARunMayBeStartedWhenAnotherEnds) {
  write("a.spt", "hot_message a;");
  write("b.spt", "hot_message b;");
  start_when_ended_ = {"scripts/a.spt", "b"};
  ASSERT_TRUE(sut_->start_file("a"));
  run_all();
  EXPECT_EQ(gateway_.calls, (Calls{"show_message [a]", "show_message [b]"}));
}

}  // namespace
}  // namespace cellmirror::script
