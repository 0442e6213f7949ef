#include "ipc/sandbox/sandbox.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "tests/unit/sandbox/sandbox_fixture.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

class SandboxTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(sut_.sandbox.start().has_value());
    ASSERT_EQ(sut_.ask("echo"), "echo");
  }
  // It does that, is replaced, and the next one answers.
  std::string reason_after(std::string_view what) {
    EXPECT_TRUE(sut_.tell(what));
    const std::string why = sut_.end(1);
    EXPECT_TRUE(sut_.started(2));
    EXPECT_EQ(sut_.ask("echo"), "echo") << "after " << what;
    EXPECT_EQ(sut_.sandbox.report().restarts, 1U);
    EXPECT_EQ(sut_.sandbox.report().last_exit, why);
    EXPECT_EQ(sut_.sandbox.outage(), "");
    return why;
  }

  ProbeSandbox sut_;
};

TEST_F(SandboxTest, ReplacesAProcessThatAborts) { EXPECT_EQ(reason_after("abort"), "was ended by signal 6 (SIGABRT)"); }

TEST_F(SandboxTest, ReplacesAProcessThatIsKilled) {
  ASSERT_EQ(kill(sut_.sandbox.report().pid, SIGKILL), 0);
  EXPECT_EQ(sut_.end(1), "was ended by signal 9 (SIGKILL)");
  EXPECT_TRUE(sut_.started(2));
}

TEST_F(SandboxTest, ReplacesAProcessThatIsStopped) {
  ASSERT_EQ(kill(sut_.sandbox.report().pid, SIGSTOP), 0);
  EXPECT_EQ(sut_.end(1), "was stopped by signal 19 (SIGSTOP)");
  EXPECT_TRUE(sut_.started(2));
}

TEST_F(SandboxTest, ReplacesAProcessThatEnds) { EXPECT_EQ(reason_after("exit"), "ended with status 3"); }

TEST_F(SandboxTest, ReplacesAProcessThatHangs) { EXPECT_THAT(reason_after("hang"), HasSubstr("did not answer for")); }

TEST_F(SandboxTest, ReplacesAProcessThatClosesItsConnection) {
  EXPECT_EQ(reason_after("close"), "closed its connection to cellmirror");
}

TEST_F(SandboxTest, ReplacesAProcessThatEatsMemory) {
  EXPECT_EQ(reason_after("eat memory"), "reached its memory limit of 64 MB");
}

TEST_F(SandboxTest, ReplacesAProcessThatDamagesTheSharedMemory) {
  EXPECT_EQ(reason_after("damage"), "damaged the memory that it shares with cellmirror");
}

TEST_F(SandboxTest, ReplacesAProcessThatFloodsItWithMessages) {
  EXPECT_THAT(reason_after("flood"), HasSubstr("flooded cellmirror with"));
}

TEST_F(SandboxTest, ReplacesAProcessThatWakesItForNothing) {
  EXPECT_THAT(reason_after("wake"), HasSubstr("times per second for nothing"));
}

TEST_F(SandboxTest, ReplacesAProcessThatComputesForEver) {
  EXPECT_THAT(reason_after("compute"), testing::MatchesRegex("computed for [0-9]+ s without a result"));
}

TEST_F(SandboxTest, SharedMemoryCannotBeMadeShorter) {
  EXPECT_THAT(sut_.ask("truncate"), HasSubstr("truncate: Operation not permitted"));
  EXPECT_EQ(sut_.ask("echo"), "echo");
}

TEST_F(SandboxTest, SendingNeverWaitsForAProcessThatDoesNotRead) {
  ASSERT_TRUE(sut_.tell("never read"));
  const std::string text(512, 'x');
  int sent = 0;
  while (sut_.tell(text)) ASSERT_LT(++sent, 1000);
  EXPECT_GT(sent, 0);
}

TEST_F(SandboxTest, IsListedWithItsMemory) {
  EXPECT_EQ(sut_.ask("echo"), "echo");
  bool found = false;
  for (const SandboxReport& report : sandbox_reports()) {
    if (report.subject != "a test") continue;
    found = true;
    EXPECT_EQ(report.program, "sandbox_probe");
    EXPECT_EQ(report.state, SandboxState::running);
    EXPECT_GT(report.pid, 0);
  }
  EXPECT_TRUE(found);
}

TEST(Sandbox, ReportsAProgramThatIsNotThere) {
  Sandbox sut({.program = "no-such-program", .subject = "a test", .channel = {}}, {}, "probe");
  const auto started = sut.start();
  ASSERT_FALSE(started.has_value());
  EXPECT_THAT(started.error().what, HasSubstr("no-such-program cannot be started"));
}

}  // namespace
}  // namespace cellmirror
