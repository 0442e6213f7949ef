#include "app/report/loop_health.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace cellmirror::app {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLimit{100};

TEST(LoopHealth, IsGoodWhileTicksAreNew) {
  FaultStatus past;
  past.faults = 3;
  past.last = "the loop stood still; flight record: /x";
  past.reason = "the loop stood still";
  const web::Health health = loop_health(kLimit, kLimit, past);
  EXPECT_TRUE(health.ok) << "a fault that is no longer latched is past";
  EXPECT_EQ(health.text, "ok");
}

TEST(LoopHealth, TellsHowLongTheLoopStandsStill) {
  const web::Health health = loop_health(milliseconds(350), kLimit, {});
  EXPECT_FALSE(health.ok);
  EXPECT_EQ(health.text, "the loop stands still: its newest tick is 0.35 s old");
}

TEST(LoopHealth, TellsALatchedFaultWithoutTheFilesOfItsRecord) {
  const FaultStatus latched{1, true, "20 periods missed within a second", "20 ...; flight record: /var/lib/x"};
  const web::Health health = loop_health(milliseconds(1), kLimit, latched);
  EXPECT_FALSE(health.ok);
  EXPECT_NE(health.text.find("20 periods missed within a second"), std::string::npos);
  EXPECT_EQ(health.text.find("/var"), std::string::npos);
}

}  // namespace
}  // namespace cellmirror::app
