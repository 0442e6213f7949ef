#include "app/subcommands/stream_wait.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace cellmirror::app {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

json robot(const char* id, const char* mode, const char* kind, const char* state, const char* condition = "") {
  return {{"id", id}, {"mode", mode}, {"stream", {{"kind", kind}, {"state", state}, {"condition", condition}}}};
}

const json kStatus{
    {"robots",
     {robot("A", "mirrored", "dds", "fresh", "1 publisher"), robot("B", "simulated", "dds", "off", "closed"),
      robot("C", "simulated", "none", "off"), robot("D", "mirrored", "dds", "lost", "no publisher")}}};

TEST(StreamWait, LooksAtAllRobotsThatAreOnline) {
  const StreamWaitResult result = look_at_streams(kStatus, {"fresh", {}});
  EXPECT_THAT(result.there, ElementsAre("A"));
  EXPECT_EQ(result.missing, "D is lost (no publisher)");
  json good = kStatus;
  good["robots"][3]["stream"]["state"] = "fresh";
  EXPECT_THAT(look_at_streams(good, {"fresh", {}}).there, ElementsAre("A", "D"));
  EXPECT_EQ(look_at_streams(good, {"fresh", {}}).missing, "");
}

TEST(StreamWait, NoRobotIsNotEveryRobot) {
  const json status{{"robots", {kStatus["robots"][1], kStatus["robots"][2]}}};
  EXPECT_EQ(look_at_streams(status, {"fresh", {}}).missing, "no robot is online");
}

TEST(StreamWait, LooksAtTheRobotsThatAreNamed) {
  EXPECT_EQ(look_at_streams(kStatus, {"fresh", {"A"}}).missing, "");
  EXPECT_EQ(look_at_streams(kStatus, {"lost", {"D"}}).missing, "");
  const StreamWaitResult result = look_at_streams(kStatus, {"fresh", {"B", "C", "X"}});
  EXPECT_THAT(result.there, IsEmpty());
  EXPECT_EQ(result.missing, "B is not online, C has no stream, there is no robot X");
}

}  // namespace
}  // namespace cellmirror::app
