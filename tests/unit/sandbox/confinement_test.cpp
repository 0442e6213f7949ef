#include "ipc/sandbox/confinement.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/unit/sandbox/sandbox_fixture.hpp"

namespace cellmirror {
namespace {

class NetworkConfinementTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(sut_.sandbox.start().has_value()); }

  ProbeSandbox sut_;
};

TEST_F(NetworkConfinementTest, ATakenOverProcessReachesNothing) {
  for (const char* what : {"write a file", "read a file", "start a process", "start a program", "signal its parent",
                           "connect by TCP", "trace its parent", "make a raw socket"}) {
    const std::string answer = sut_.ask(std::string("try ") + what);
    EXPECT_NE(answer, "worked") << what;
    EXPECT_NE(answer, "unknown") << what;
    EXPECT_NE(answer, "") << what;
  }
}

TEST_F(NetworkConfinementTest, TheOutcomeIsReported) {
  ASSERT_EQ(sut_.ask("echo"), "echo");
  const ConfinementOutcome* outcome = nullptr;
  SandboxReport report;
  for (int i = 0; i < 600 && outcome == nullptr; ++i) {  // it is read with the memory
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    report = sut_.sandbox.report();
    if (report.memory_bytes > 0) outcome = &report.confinement;
  }
  ASSERT_NE(outcome, nullptr);
  EXPECT_TRUE(outcome->system_calls);
}

TEST_F(NetworkConfinementTest, ItMaySpeakUdpAndReadFilesOfTheSystem) {
  EXPECT_EQ(sut_.ask("try send a datagram"), "worked");
  EXPECT_EQ(sut_.ask("try read a system file"), "worked");
}

TEST_F(NetworkConfinementTest, LaterItOpensNoFileAtAll) {
  ASSERT_EQ(sut_.ask("forbid opening"), "done");
  EXPECT_EQ(sut_.ask("try read a system file"), "Operation not permitted");
  EXPECT_EQ(sut_.ask("try send a datagram"), "worked");
}

}  // namespace
}  // namespace cellmirror
